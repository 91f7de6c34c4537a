// How much a JSON text may hold. Sent before it is parsed: what a parser makes of a text takes up
// to a hundred times the memory of the text, and a few bytes open a new level.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace troffer {

struct JsonLimits {
  size_t depth = 200;  // arrays and objects within each other
  size_t values =
      10'000'000;  // of all kinds, arrays and objects too; about 1 GB in memory at worst
};

// Throws InputError with the place where a level or a value is one too many. The text
// need not be well formed: of what a parser would take of it before its first error, no more values
// and levels than are allowed are left.
void check_limits(std::string_view text, const JsonLimits& limits, const std::string& file);

}  // namespace troffer
