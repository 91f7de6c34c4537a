#include "import/json_limits.h"

#include "base/error.h"
#include "import/json_location.h"

namespace troffer {

namespace {

// Returns the offset after the string that begins at `at`.
size_t end_of_string(std::string_view text, size_t at) {
  for (++at; at < text.size() && text[at] != '"'; ++at)
    if (text[at] == '\\') ++at;
  return at + 1;
}

}  // namespace

void check_limits(std::string_view text, const JsonLimits& limits, const std::string& file) {
  const auto refuse = [&](size_t at, const std::string& what) {
    const TextPosition p = position_of_offset(text, at);
    throw InputError(file, p.line, p.column, "JSON " + what);
  };
  // Every value but the outermost follows a bracket or a comma. An empty array counts one too many.
  size_t depth = 0, values = 1;
  for (size_t at = 0; at < text.size();) {
    switch (text[at]) {
      case '"':
        at = end_of_string(text, at);
        continue;
      case '[':
      case '{':
        if (++depth > limits.depth)
          refuse(at, "with more than " + std::to_string(limits.depth) +
                         " levels of arrays and objects");
        ++values;
        break;
      case ',':
        ++values;
        break;
      case ']':
      case '}':
        if (depth > 0) --depth;
        break;
      default:
        break;
    }
    if (values > limits.values)
      refuse(at, "with more than " + std::to_string(limits.values) + " values");
    ++at;
  }
}

}  // namespace troffer
