#include "app/option_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "app/printable.h"
#include "base/suggestion.h"

namespace troffer {

namespace {

// Descriptions leave out bounds from this size on, which only catch nonsense.
constexpr double untold = 1e6;

std::optional<double> number_in(const std::string& text) {
  const size_t sign = text.starts_with("+") ? 1 : 0;
  double v = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + sign, end, v);
  return error == std::errc() && stop == end && std::isfinite(v) ? std::optional(v) : std::nullopt;
}

std::string shown(const std::string& text) {
  return "'" + printable(text.substr(0, 60)) + "'";
}

// Formats a number without an exponent: 0.000001.
std::string plain(double v) {
  if (v == 0 || std::abs(v) >= 1e-3) return fmt::format("{}", v);
  std::string text = fmt::format("{:.9f}", v);
  text.erase(text.find_last_not_of('0') + 1);
  return text;
}

std::string range_text(double least, double most) {
  if (most >= untold && least <= -untold) return "";
  if (most >= untold) return plain(least) + " or more";
  return plain(least) + " to " + plain(most);
}

std::string out_of_range(const std::string& text, double v, double least, double most,
                         const char* kind) {
  const std::string advice =
      most >= untold && v < least
          ? fmt::format("write {} of {} or more", kind, plain(least))
          : fmt::format("write {} from {} to {}", kind, plain(least), plain(most));
  return fmt::format("{} is too {}: {}", printable(text.substr(0, 60)),
                     v < least ? "small" : "large", advice);
}

}  // namespace

CLI::Validator number_between(double least, double most) {
  const auto check = [least, most](std::string& text) -> std::string {
    const std::optional<double> v = number_in(text);
    if (!v) return shown(text) + " is not a number";
    if (*v >= least && *v <= most) return "";
    return out_of_range(text, *v, least, most, "a number");
  };
  return {check, range_text(least, most), number_kind};
}

CLI::Validator whole_number_between(int64_t least, int64_t most) {
  const auto low = double(least), high = double(most);
  const auto check = [low, high](std::string& text) -> std::string {
    const std::optional<double> v = number_in(text);
    if (!v) return shown(text) + " is not a whole number";
    if (*v >= low && *v <= high) return "";
    return out_of_range(text, *v, low, high, "a whole number");
  };
  return {check, range_text(low, high), whole_number_kind};
}

CLI::Validator number_above_zero() {
  const auto check = [](std::string& text) -> std::string {
    const std::optional<double> v = number_in(text);
    return v && *v > 0 ? "" : shown(text) + " is not a number above 0";
  };
  return {check, "above 0", number_kind};
}

CLI::Validator one_of(const std::vector<std::string>& words) {
  std::string joined;
  for (const std::string& w : words) joined += (joined.empty() ? "" : "|") + w;
  const auto check = [words](std::string& text) -> std::string {
    if (std::find(words.begin(), words.end(), text) != words.end()) return "";
    const std::string suggestion = did_you_mean(text, words);
    return fmt::format("there is no {}{}", shown(text),
                       suggestion.empty() ? ", but " + listed_with_or(words)
                                          : suggestion + " (" + listed_with_or(words) + ")");
  };
  return {check, joined, choice_kind};
}

std::string listed_with_or(const std::vector<std::string>& words) {
  std::string text;
  for (size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  return text;
}

std::vector<std::string> split_at(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

}  // namespace troffer
