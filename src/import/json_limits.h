// Limits on the contents of a JSON text, checked before it is parsed (JsonDocument). A parsed text
// may take a hundred times its memory, and every few bytes may open a new level.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace troffer {

struct JsonLimits {
  size_t depth = 200;  // nested arrays and objects
  size_t values =
      10'000'000;  // values of all kinds, arrays and objects included; at most about 1 GB in memory
};

// Throws InputError at the first level or value beyond the limits. The text need not be well
// formed: before its first error, a parser never meets more values and levels than are counted
// here.
void check_limits(std::string_view text, const JsonLimits& limits, const std::string& file);

}  // namespace troffer
