#include "import/text_lines.h"

#include <charconv>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "base/error.h"

namespace troffer {

namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

}  // namespace

TextLines::TextLines(const std::string& file, std::string_view text) : file_(file), text_(text) {
  if (text_.starts_with("\xef\xbb\xbf")) next_ = 3;  // byte order mark
}

std::string_view TextLines::take_physical_line() {
  const char* const begin = text_.data() + next_;
  const size_t left = text_.size() - next_;
  const void* const newline = std::memchr(begin, '\n', left);
  size_t n = newline ? size_t(static_cast<const char*>(newline) - begin) : left;
  size_t taken = newline ? n + 1 : n;
  // Files of lone carriage returns.
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
  while (at_ < end_ && is_blank(*at_)) ++at_;
  word_ = at_;
}

bool TextLines::has_word() {
  skip_blanks();
  return at_ < end_ && *at_ != '#';
}

std::string_view TextLines::word() {
  if (!has_word()) return {};
  while (at_ < end_ && !is_blank(*at_)) ++at_;
  return {word_, size_t(at_ - word_)};
}

std::string_view TextLines::rest() {
  skip_blanks();
  const char* last = end_;
  while (last > at_ && is_blank(last[-1])) --last;
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
  const bool is_whole = result.ptr == end_ || is_blank(*result.ptr);
  if (result.ec == std::errc::invalid_argument || !is_whole) {
    const std::string_view found = word();
    // What some C libraries print for NaN and infinity: 1.#IND, -1.#INF.
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
