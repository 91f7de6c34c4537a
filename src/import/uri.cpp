#include "import/uri.h"

#include <algorithm>
#include <array>

namespace troffer {

namespace {

constexpr int hex_value(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
}
bool is_letter(char c) {
  return lower(c) >= 'a' && lower(c) <= 'z';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// Value of each base64 character; -1 for others.
constexpr std::array<int8_t, 256> base64_values = [] {
  std::array<int8_t, 256> table{};
  table.fill(-1);
  constexpr std::string_view alphabet =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (size_t i = 0; i < alphabet.size(); ++i)
    table[static_cast<unsigned char>(alphabet[i])] = int8_t(i);
  return table;
}();

}  // namespace

std::optional<std::string> percent_decoded(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i];
      continue;
    }
    if (i + 2 >= text.size()) return std::nullopt;
    const int high = hex_value(text[i + 1]), low = hex_value(text[i + 2]);
    if (high < 0 || low < 0) return std::nullopt;
    out += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return out;
}

bool has_uri_scheme(std::string_view uri) {
  if (uri.empty() || !is_letter(uri[0])) return false;
  for (const char c : uri) {
    if (c == ':') return true;
    if (!is_letter(c) && !is_digit(c) && c != '+' && c != '-' && c != '.') return false;
  }
  return false;
}

bool is_data_uri(std::string_view uri) {
  constexpr std::string_view scheme = "data:";
  return uri.size() >= scheme.size() && std::equal(scheme.begin(), scheme.end(), uri.begin(),
                                                   [](char a, char b) { return a == lower(b); });
}

std::optional<DataUri> parse_data_uri(std::string_view uri) {
  if (!is_data_uri(uri)) return std::nullopt;
  uri.remove_prefix(5);
  const size_t comma = uri.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  std::string head(uri.substr(0, comma));
  std::transform(head.begin(), head.end(), head.begin(), lower);
  const std::string_view data = uri.substr(comma + 1);

  DataUri out;
  out.media_type = head.substr(0, head.find(';'));
  if (head.ends_with(";base64")) {
    // '=' and '/' may be percent-encoded.
    std::optional<std::vector<uint8_t>> bytes;
    if (data.find('%') == std::string_view::npos) {
      bytes = base64_decoded(data);
    } else if (const auto plain = percent_decoded(data)) {
      bytes = base64_decoded(*plain);
    }
    if (!bytes) return std::nullopt;
    out.bytes = std::move(*bytes);
  } else {
    const auto plain = percent_decoded(data);
    if (!plain) return std::nullopt;
    out.bytes.assign(plain->begin(), plain->end());
  }
  return out;
}

std::optional<std::vector<uint8_t>> base64_decoded(std::string_view text) {
  size_t padding = 0;
  while (padding < 2 && text.ends_with('=')) {
    text.remove_suffix(1);
    ++padding;
  }
  const size_t rest = text.size() % 4;
  if (rest == 1 || (padding > 0 && rest + padding != 4)) return std::nullopt;

  std::vector<uint8_t> out;
  out.reserve(text.size() / 4 * 3 + 2);
  uint32_t bits = 0;
  size_t count = 0;
  for (const char c : text) {
    const int8_t value = base64_values[static_cast<unsigned char>(c)];
    if (value < 0) return std::nullopt;
    bits = (bits << 6) | uint32_t(value);
    if (++count % 4 != 0) continue;
    out.push_back(uint8_t(bits >> 16));
    out.push_back(uint8_t(bits >> 8));
    out.push_back(uint8_t(bits));
    bits = 0;
  }
  // Two remaining characters hold one byte, three hold two; left-over bits are ignored.
  if (rest == 2) out.push_back(uint8_t(bits >> 4));
  if (rest == 3) {
    out.push_back(uint8_t(bits >> 10));
    out.push_back(uint8_t(bits >> 2));
  }
  return out;
}

}  // namespace troffer
