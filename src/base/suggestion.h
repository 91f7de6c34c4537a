// Suggests the known name nearest to a mistyped one, for messages that end in "did you mean
// 'lamp'?".
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace troffer {

// Number of insertions, deletions, replacements and swaps of neighbours that turn `a` into `b`,
// ignoring case (restricted Damerau-Levenshtein distance, in bytes).
size_t edit_distance(std::string_view a, std::string_view b);

// Returns the name that differs from `word` in at most a third of its letters or begins with it;
// empty if there is none. Of several equally near names it returns the first.
std::string nearest_name(std::string_view word, const std::vector<std::string>& names);

// Returns "; did you mean 'lamp'?", or an empty string.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& names);

}  // namespace troffer
