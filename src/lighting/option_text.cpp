#include "lighting/option_text.h"

#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>

namespace troffer {

std::optional<double> parse_number(const std::string& text) {
  const size_t first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  if (first == std::string::npos) return std::nullopt;
  std::string_view number = std::string_view(text).substr(first, last + 1 - first);
  if (number.size() > 1 && number[0] == '+' && number[1] != '-') number.remove_prefix(1);
  double v = 0;
  const char* const end = number.data() + number.size();
  const auto [stop, error] = std::from_chars(number.data(), end, v);
  if (error != std::errc() || stop != end || !std::isfinite(v)) return std::nullopt;
  return v;
}

std::vector<std::string> split_text(const std::string& text, char separator) {
  std::vector<std::string> parts{""};
  for (const char c : text)
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

}  // namespace troffer
