#include "import/luminaire/photometric_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/error.h"

namespace troffer {

namespace {

bool is_photometric_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f' || c == '\0' || c == '\x1a';
}

}  // namespace

std::string_view trimmed(std::string_view s) {
  while (!s.empty() && is_photometric_blank(s.front())) s.remove_prefix(1);
  while (!s.empty() && is_photometric_blank(s.back())) s.remove_suffix(1);
  return s;
}

void PhotometricText::fail(const std::string& what) const {
  throw InputError(file_, int(std::max<size_t>(line_, 1)), int(column_), what);
}

size_t PhotometricText::after_break(size_t at) const {
  const size_t other = std::min(text_.find_first_not_of('\r', at), text_.size());
  if (other < text_.size() && text_[other] == '\n') return other + 1;
  return std::min(at + 1, text_.size());
}

bool PhotometricText::is_separator(size_t at) const {
  const char c = text_[at];
  if (c != ',') return is_photometric_blank(c) || c == '\n';
  const bool is_before_digit =
      at + 1 < text_.size() && text_[at + 1] >= '0' && text_[at + 1] <= '9';
  return !are_commas_decimal_ || !is_before_digit;
}

std::string_view PhotometricText::take_line() {
  ++line_;
  column_ = 1;
  line_start_ = next_;
  const size_t end = std::min(text_.find_first_of("\r\n", next_), text_.size());
  const std::string_view line = text_.substr(next_, end - next_);
  next_ = after_break(end);
  return line;
}

bool PhotometricText::next_line(std::string_view& line) {
  is_in_line_ = false;
  if (next_ >= text_.size()) return false;
  line = trimmed(take_line());
  return true;
}

double PhotometricText::parse(std::string_view word, const char* name, double least, double most) {
  std::string plain(word.substr(0, 64));
  if (!plain.empty() && plain.front() == '+') plain.erase(0, 1);
  const size_t comma = plain.find(',');
  if (comma != plain.npos) {
    plain[comma] = '.';
    has_met_commas_ = true;
  }
  double value = 0;
  const auto [end, error] = std::from_chars(plain.data(), plain.data() + plain.size(), value);
  if (error != std::errc() || end != plain.data() + plain.size() || !std::isfinite(value))
    fail(fmt::format("{}: a number expected", name));
  if (value < least || value > most)
    fail(fmt::format("{}: {} does not lie between {} and {}", name, value, least, most));
  return value;
}

double PhotometricText::number(const char* name, double least, double most) {
  if (!is_in_line_) {
    ++line_;
    line_start_ = next_;
    is_in_line_ = true;
  }
  while (next_ < text_.size() && is_separator(next_)) {
    const bool is_break = text_[next_] == '\n' || text_[next_] == '\r';
    next_ = is_break ? after_break(next_) : next_ + 1;
    if (is_break) {
      ++line_;
      line_start_ = next_;
    }
  }
  column_ = next_ - line_start_ + 1;
  if (next_ >= text_.size()) fail(fmt::format("{}: the file ends too soon", name));
  const size_t first = next_;
  while (next_ < text_.size() && !is_separator(next_)) ++next_;
  return parse(text_.substr(first, next_ - first), name, least, most);
}

int PhotometricText::integer(const char* name, int least, int most) {
  const double v = number(name, least, most);
  if (v != std::floor(v)) fail(fmt::format("{}: a whole number expected", name));
  return int(v);
}

double PhotometricText::number_of_line(const char* name, double least, double most) {
  std::string_view line;
  if (!next_line(line)) fail(fmt::format("{}: the file ends too soon", name));
  const size_t end = line.find_first_of(" \t;");
  line = line.substr(0, end);
  return line.empty() ? std::clamp(0.0, least, most) : parse(line, name, least, most);
}

int PhotometricText::integer_of_line(const char* name, int least, int most) {
  const double v = number_of_line(name, least, most);
  if (v != std::floor(v)) fail(fmt::format("{}: a whole number expected", name));
  return int(v);
}

}  // namespace troffer
