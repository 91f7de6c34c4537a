#include "app/plain_numbers.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <type_traits>

namespace troffer {

namespace {

// True if all of the text is a number of this type. is_large: it is a number, but out of range.
template <class Number>
bool is_number(const std::string& text, bool& is_large) {
  Number v{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, v);
  is_large = error == std::errc::result_out_of_range && stop == end;
  if (error != std::errc() || stop != end) return false;
  if constexpr (std::is_floating_point_v<Number>) return std::isfinite(v);
  return true;
}

bool is_number(NumberKind kind, const std::string& text, bool& is_large) {
  switch (kind) {
    case NumberKind::natural:
      return is_number<uint64_t>(text, is_large);
    case NumberKind::integer:
      return is_number<int64_t>(text, is_large);
    case NumberKind::real:
      break;
  }
  return is_number<double>(text, is_large);
}

// Normalizes a number: "+007" becomes "7".
std::string plain(std::string text) {
  if (text.size() > 1 && text[0] == '+') text.erase(0, 1);
  const size_t first = !text.empty() && text[0] == '-' ? 1 : 0;
  const auto is_digit = [&](size_t i) {
    return i < text.size() && text[i] >= '0' && text[i] <= '9';
  };
  while (is_digit(first) && text[first] == '0' && is_digit(first + 1)) text.erase(first, 1);
  return text;
}

}  // namespace

std::optional<std::string> check_number(NumberKind kind, std::string& text) {
  const std::string number = plain(text);
  const bool has_two_signs = text.size() > 1 && text[0] == '+' && text[1] == '-';
  bool is_large = false;
  if (!has_two_signs && is_number(kind, number, is_large)) {
    text = number;
    return std::nullopt;
  }
  if (is_large) return fmt::format("'{}' has too many digits", text);
  if (kind == NumberKind::natural && number.size() > 1 && number[0] == '-' &&
      is_number(NumberKind::integer, number, is_large))
    return fmt::format("'{}' is below 0", text);
  if (kind == NumberKind::real) {
    std::string with_point = number;
    std::replace(with_point.begin(), with_point.end(), ',', '.');
    if (with_point != number && is_number(kind, with_point, is_large))
      return fmt::format("'{}' has a comma: write {}", text, with_point);
    return fmt::format("'{}' is not a number", text);
  }
  return fmt::format("'{}' is not a whole number", text);
}

void require_plain_numbers(CLI::App& app) {
  const auto kind_of = [](const std::string& type) -> std::optional<NumberKind> {
    if (type.rfind("UINT", 0) == 0) return NumberKind::natural;
    if (type.rfind("INT", 0) == 0) return NumberKind::integer;
    if (type.rfind("FLOAT", 0) == 0) return NumberKind::real;
    return std::nullopt;
  };
  for (CLI::App* command : app.get_subcommands({})) {
    for (CLI::Option* option : command->get_options()) {
      const auto kind = kind_of(option->get_type_name());
      if (!kind) continue;
      option->transform(CLI::Validator(
          [kind](std::string& text) { return check_number(*kind, text).value_or(""); }, ""));
    }
  }
}

}  // namespace troffer
