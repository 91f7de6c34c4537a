#include "report/html_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace troffer {

namespace {

constexpr const char* replacement = "\xef\xbf\xbd";

// Decodes the UTF-8 sequence at the beginning of the text. Returns its length, or 0 if it is
// invalid.
size_t decode(std::string_view t, uint32_t& code) {
  const auto byte = [&](size_t i) { return uint32_t(static_cast<unsigned char>(t[i])); };
  const uint32_t first = byte(0);
  const size_t n = first < 0x80       ? 1
                   : first >> 5 == 6  ? 2
                   : first >> 4 == 14 ? 3
                   : first >> 3 == 30 ? 4
                                      : 0;
  if (n == 0 || t.size() < n) return 0;
  code = n == 1 ? first : first & (0x7fu >> n);
  for (size_t i = 1; i < n; ++i) {
    if (byte(i) >> 6 != 2) return 0;
    code = code << 6 | (byte(i) & 0x3f);
  }
  constexpr uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xd800 && code < 0xe000;
  return code < least[n] || code > 0x10ffff || is_surrogate ? 0 : n;
}

bool is_shown(uint32_t c) {
  const bool is_control = (c < 0x20 && c != '\t' && c != '\n') || (c >= 0x7f && c < 0xa0);
  const bool is_turn = (c >= 0x202a && c <= 0x202e) || (c >= 0x2066 && c <= 0x2069);
  return !is_control && !is_turn && c != 0xfffe && c != 0xffff;
}

const char* entity(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    default:
      return nullptr;
  }
}

}  // namespace

std::string html_text(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    uint32_t code = 0;
    const size_t n = decode(text, code);
    if (n == 0 || !is_shown(code))
      out += replacement;
    else if (const char* e = n == 1 ? entity(text[0]) : nullptr)
      out += e;
    else
      out += text.substr(0, n);
    text.remove_prefix(std::max<size_t>(n, 1));
  }
  return out;
}

std::string html_name(std::string_view text) {
  constexpr size_t longest = 32;
  std::string out;
  size_t from = 0;
  for (size_t i = 0; i < text.size(); ++i) {
    const bool is_last = i + 1 == text.size();
    const bool is_start = is_last || (static_cast<unsigned char>(text[i + 1]) & 0xc0) != 0x80;
    const bool is_mark = std::string_view("/\\_-.:").find(text[i]) != std::string_view::npos;
    const bool is_long = i - from + 1 >= longest && is_start;
    if (text[i] == ' ') {
      out += html_text(text.substr(from, i + 1 - from));
      from = i + 1;
    } else if (!is_last && (is_mark || is_long)) {
      out += html_text(text.substr(from, i + 1 - from)) + "<wbr>";
      from = i + 1;
    }
  }
  return out + html_text(text.substr(from));
}

std::string csv_field(std::string_view text) {
  std::string out = "\"";
  if (!text.empty() && std::string_view("=+-@\t\r").find(text[0]) != std::string_view::npos)
    out += '\'';
  for (const char c : text) {
    if (c == '"') out += '"';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out + "\"";
}

std::string base64(std::span<const uint8_t> bytes) {
  static constexpr char digits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t n = std::min<size_t>(3, bytes.size() - i);
    uint32_t word = uint32_t(bytes[i]) << 16;
    if (n > 1) word |= uint32_t(bytes[i + 1]) << 8;
    if (n > 2) word |= bytes[i + 2];
    out += digits[word >> 18];
    out += digits[word >> 12 & 63];
    out += n > 1 ? digits[word >> 6 & 63] : '=';
    out += n > 2 ? digits[word & 63] : '=';
  }
  return out;
}

std::string short_number(double v) {
  const double size = std::abs(v);
  if (!std::isfinite(v)) return "–";
  if (size >= 100 || size == 0) return fmt::format("{:.0f}", v);
  return size >= 10  ? fmt::format("{:.1f}", v)
         : size >= 1 ? fmt::format("{:.2f}", v)
                     : fmt::format("{:.3f}", v);
}

std::string with_error(double value, double error) {
  if (!(error > 0)) return short_number(value);
  const auto power = [](double v) { return int(std::floor(std::log10(v))); };
  // Four digits of the value suffice if they still show the error.
  const int by_error = 1 - power(error);
  const int by_value = 3 - power(std::max(std::abs(value), error));
  const int digits = std::clamp(std::min(by_error, std::max(by_value, by_error - 1)), 0, 4);
  return fmt::format("{:.{}f} ± {:.{}f}", value, digits, error, digits);
}

}  // namespace troffer
