// The known name nearest to a mistyped one, for messages that end in "did you mean …?".
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace troffer {

// Letters to insert, delete, replace or swap with their neighbour to make `b` of `a`, regardless of
// case (restricted Damerau-Levenshtein distance, in bytes).
size_t edit_distance(std::string_view a, std::string_view b);

// The name that differs from `word` in at most a third of its letters, or begins with it; empty
// where there is none. The first of several that are equally near.
std::string nearest_name(std::string_view word, const std::vector<std::string>& names);

// "; did you mean 'lamp'?", or nothing.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& names);

}  // namespace troffer
