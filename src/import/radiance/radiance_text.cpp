#include "import/radiance/radiance_text.h"

#include <charconv>
#include <cmath>

namespace troffer {

namespace {

constexpr size_t max_arguments = 30'000'000;
constexpr size_t max_views = 100;

bool is_radiance_blank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}

}  // namespace

double radiance_number(const std::string& word, const SourcePlace& place) {
  const char* begin = word.data();
  const char* const end = begin + word.size();
  if (begin < end && *begin == '+') ++begin;
  double value = 0;
  const auto result = std::from_chars(begin, end, value);
  if (result.ec != std::errc() || result.ptr != end || !std::isfinite(value))
    place.fail(word.empty() ? "a number is missing" : "'" + shortened(word) + "' is not a number");
  return value;
}

std::vector<std::string> words_of(std::string_view line) {
  std::vector<std::string> words;
  for (size_t i = 0; i < line.size();) {
    if (is_radiance_blank(line[i])) {
      ++i;
      continue;
    }
    const char quote = line[i] == '"' || line[i] == '\'' ? line[i] : '\0';
    const size_t begin = quote != '\0' ? i + 1 : i;
    size_t end = begin;
    while (end < line.size() &&
           (quote != '\0' ? line[end] != quote : !is_radiance_blank(line[end])))
      ++end;
    words.emplace_back(line.substr(begin, end - begin));
    i = end + (quote != '\0' ? 1 : 0);
  }
  return words;
}

void RadianceText::skip_blanks() {
  while (at_ < text_.size()) {
    if (text_[at_] == '#') {
      const size_t end = std::min(text_.find('\n', at_), text_.size());
      const std::string_view comment = text_.substr(at_, end - at_);
      if (views_.size() < max_views && comment.find("-vp") != std::string_view::npos)
        views_.emplace_back(comment);
      at_ = end;
    } else if (!is_radiance_blank(text_[at_])) {
      return;
    } else {
      if (text_[at_] == '\n') {
        ++line_;
        line_begin_ = at_ + 1;
      }
      ++at_;
    }
  }
}

std::string RadianceText::word() {
  skip_blanks();
  line_of_word_ = line_;
  column_of_word_ = int(at_ - line_begin_) + 1;
  if (at_ >= text_.size()) return "";
  const char quote = text_[at_] == '"' || text_[at_] == '\'' ? text_[at_] : '\0';
  const size_t begin = quote != '\0' ? at_ + 1 : at_;
  size_t end = begin;
  while (end < text_.size() && (quote != '\0' ? text_[end] != quote && text_[end] != '\n'
                                              : !is_radiance_blank(text_[end])))
    ++end;
  at_ = end + (quote != '\0' && end < text_.size() && text_[end] == quote ? 1 : 0);
  if (end == begin) return " ";  // an empty string in quotes is a word too
  return std::string(text_.substr(begin, end - begin));
}

std::string RadianceText::first_word() {
  skip_blanks();
  if (at_ >= text_.size() || text_[at_] != '!') return word();
  line_of_word_ = line_;
  column_of_word_ = int(at_ - line_begin_) + 1;
  ++at_;
  return "!";
}

std::string RadianceText::command() {
  std::string out;
  while (at_ < text_.size() && text_[at_] != '\n') {
    if (text_[at_] == '\\' &&
        text_.substr(at_ + 1).find_first_not_of(" \t\r") != std::string_view::npos &&
        text_[text_.find_first_not_of(" \t\r", at_ + 1)] == '\n') {
      at_ = text_.find('\n', at_) + 1;
      ++line_;
      line_begin_ = at_;
      out += ' ';
      continue;
    }
    out += text_[at_++];
  }
  return out;
}

double RadianceText::number() {
  const std::string text = word();
  return radiance_number(text, place());
}

size_t RadianceText::count() {
  const double n = number();
  if (!(n >= 0 && n <= double(max_arguments)) || n != std::floor(n))
    place().fail("the number of arguments expected");
  return size_t(n);
}

std::string RadianceText::argument(const char* what) {
  std::string text = word();
  if (text.empty()) place().fail(std::string("the file ends within ") + what);
  return text;
}

RadianceArguments RadianceText::arguments() {
  RadianceArguments out;
  for (size_t n = count(); n > 0; --n) out.strings.push_back(argument("string arguments"));
  for (size_t n = count(); n > 0; --n) argument("integer arguments");
  for (size_t n = count(); n > 0; --n) {
    const std::string text = argument("real arguments");
    out.reals.push_back(radiance_number(text, place()));
  }
  return out;
}

}  // namespace troffer
