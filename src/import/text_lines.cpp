#include "import/text_lines.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "base/error.h"

namespace troffer {

namespace {

bool is_blank_in_line(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

}  // namespace

// Checks the lengths of multi-byte characters; accepts overlong forms.
bool is_utf8(std::string_view text) {
  constexpr uint64_t high_bits = 0x8080808080808080u;
  for (size_t i = 0; i < text.size(); ++i) {
    for (uint64_t eight = 0; text.size() - i > 8; i += 8) {
      std::memcpy(&eight, text.data() + i, 8);
      if ((eight & high_bits) != 0) break;
    }
    const auto c = static_cast<unsigned char>(text[i]);
    if (c < 0x80) continue;
    const size_t more = c >= 0xf0 && c < 0xf8 ? 3 : c >= 0xe0 ? 2 : 1;
    if (c < 0xc2 || c >= 0xf8 || more >= text.size() - i) return false;
    for (size_t k = 1; k <= more; ++k)
      if ((static_cast<unsigned char>(text[i + k]) & 0xc0) != 0x80) return false;
    i += more;
  }
  return true;
}

void append_utf8(std::string& out, uint32_t code_point) {
  const auto put = [&](uint32_t bits) { out += char(static_cast<unsigned char>(bits)); };
  if (code_point < 0x80) {
    put(code_point);
  } else if (code_point < 0x800) {
    put(0xc0 | code_point >> 6);
    put(0x80 | (code_point & 63));
  } else if (code_point < 0x10000) {
    put(0xe0 | code_point >> 12);
    put(0x80 | (code_point >> 6 & 63));
    put(0x80 | (code_point & 63));
  } else {
    put(0xf0 | code_point >> 18);
    put(0x80 | (code_point >> 12 & 63));
    put(0x80 | (code_point >> 6 & 63));
    put(0x80 | (code_point & 63));
  }
}

std::string as_utf8(std::string_view text) {
  const bool is_little = text.starts_with("\xff\xfe"), is_big = text.starts_with("\xfe\xff");
  if (!is_little && !is_big) {
    if (is_utf8(text)) return std::string(text);
    std::string out;
    for (const char c : text) append_utf8(out, static_cast<unsigned char>(c));
    return out;
  }
  const auto unit_at = [&](size_t i) {
    const auto a = static_cast<unsigned char>(text[i]), b = static_cast<unsigned char>(text[i + 1]);
    return is_little ? uint32_t(a | b << 8) : uint32_t(a << 8 | b);
  };
  std::string out;
  out.reserve(text.size() / 2);
  for (size_t i = 2; i + 1 < text.size(); i += 2) {
    uint32_t c = unit_at(i);
    const bool is_high = (c & 0xfc00) == 0xd800;
    if (is_high && i + 3 < text.size() && (unit_at(i + 2) & 0xfc00) == 0xdc00) {
      c = 0x10000 + ((c & 0x3ff) << 10) + (unit_at(i + 2) & 0x3ff);
      i += 2;
    }
    append_utf8(out, (c & 0xf800) == 0xd800 ? 0xfffd : c);  // half a surrogate pair is not a
                                                            // character
  }
  return out;
}

std::vector<std::string_view> cut_at_lines(std::string_view text, size_t piece_bytes,
                                           std::string_view first) {
  // True if a piece may end after that "\n".
  const auto is_cut = [&](size_t newline) {
    size_t last = newline;
    if (last > 0 && text[last - 1] == '\r') --last;
    if (last > 0 && text[last - 1] == '\\') return false;
    size_t word = newline + 1;
    while (!first.empty() && word < text.size() && is_blank_in_line(text[word])) ++word;
    return text.substr(std::min(word, text.size())).starts_with(first);
  };
  std::vector<std::string_view> pieces;
  for (size_t begin = 0; begin < text.size();) {
    size_t newline = text.find('\n', begin + std::max<size_t>(piece_bytes, 1) - 1);
    while (newline != std::string_view::npos && !is_cut(newline))
      newline = text.find('\n', newline + 1);
    const size_t end = newline == std::string_view::npos ? text.size() : newline + 1;
    pieces.push_back(text.substr(begin, end - begin));
    begin = end;
  }
  return pieces;
}

TextLines::TextLines(const std::string& file, std::string_view text, bool is_whole,
                     int lines_before)
    : file_(file), text_(text), lines_before_(lines_before), next_line_number_(lines_before + 1) {
  if (is_whole && text_.starts_with("\xef\xbb\xbf")) next_ = 3;  // byte order mark
}

std::string_view TextLines::take_physical_line() {
  const char* const begin = text_.data() + next_;
  const size_t left = text_.size() - next_;
  const void* const newline = std::memchr(begin, '\n', left);
  size_t n = newline ? size_t(static_cast<const char*>(newline) - begin) : left;
  size_t taken = newline ? n + 1 : n;
  // Lone carriage returns end lines too.
  if (const void* const cr = std::memchr(begin, '\r', n)) {
    const auto at = size_t(static_cast<const char*>(cr) - begin);
    const bool is_pair = at + 1 == n && newline;
    n = at;
    if (!is_pair) taken = at + 1;
  }
  next_ += taken;
  ++next_line_number_;
  return {begin, n};
}

bool TextLines::next_line() {
  if (next_ >= text_.size()) return false;
  line_ = next_line_number_;
  std::string_view line = take_physical_line();
  if (line.ends_with('\\')) {
    joined_.clear();
    while (line.ends_with('\\') && next_ < text_.size()) {
      joined_.append(line.substr(0, line.size() - 1));
      joined_ += ' ';
      line = take_physical_line();
    }
    joined_.append(line.ends_with('\\') ? line.substr(0, line.size() - 1) : line);
    line = joined_;
  }
  begin_ = at_ = word_ = line.data();
  end_ = begin_ + line.size();
  return true;
}

void TextLines::skip_blanks() {
  while (at_ < end_ && is_blank_in_line(*at_)) ++at_;
  word_ = at_;
}

bool TextLines::has_word() {
  skip_blanks();
  return at_ < end_ && *at_ != '#';
}

std::string_view TextLines::word() {
  if (!has_word()) return {};
  while (at_ < end_ && !is_blank_in_line(*at_)) ++at_;
  return {word_, size_t(at_ - word_)};
}

std::string_view TextLines::rest() {
  skip_blanks();
  const char* last = end_;
  while (last > at_ && is_blank_in_line(last[-1])) --last;
  at_ = end_;
  return {word_, size_t(last - word_)};
}

template <class Real>
Real TextLines::read_number() {
  skip_blanks();
  const char* begin = at_;
  if (begin < end_ && *begin == '+' && begin + 1 < end_ && begin[1] != '-') ++begin;
  Real value = 0;
  const auto result = std::from_chars(begin, end_, value);
  const bool is_whole = result.ptr == end_ || is_blank_in_line(*result.ptr);
  if (result.ec == std::errc::invalid_argument || !is_whole) {
    const std::string_view found = word();
    // Some C libraries print NaN and infinity as 1.#IND, -1.#INF.
    if (found.substr(0, 4).find("1.#") != std::string_view::npos)
      return std::numeric_limits<Real>::quiet_NaN();
    fail(found.empty() ? "a number is missing"
                       : "'" + std::string(found.substr(0, 40)) + "' is not a number");
  }
  if (result.ec == std::errc::result_out_of_range)
    value = Real(std::strtod(std::string(begin, result.ptr).c_str(), nullptr));
  at_ = result.ptr;
  return value;
}

float TextLines::number() {
  return read_number<float>();
}

double TextLines::precise_number() {
  return read_number<double>();
}

bool TextLines::integer(int& value) {
  const char* begin = at_;
  if (begin < end_ && *begin == '+' && begin + 1 < end_ && begin[1] != '-') ++begin;
  const auto result = std::from_chars(begin, end_, value);
  if (result.ec != std::errc()) return false;
  at_ = result.ptr;
  return true;
}

void TextLines::fail(const std::string& what) const {
  throw InputError(file_, line(), column(), what);
}

}  // namespace troffer
