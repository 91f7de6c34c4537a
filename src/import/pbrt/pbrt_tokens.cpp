#include "import/pbrt/pbrt_tokens.h"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "base/error.h"

namespace troffer {

namespace {

bool is_pbrt_blank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}
bool ends_word(char c) {
  return is_pbrt_blank(c) || c == '"' || c == '[' || c == ']' || c == '#' || c == '\0';
}
bool may_start_number(char c) {
  return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.';
}

// Parses a whole word. Overflow gives infinity, underflow zero or a denormal.
bool parse_number(std::string_view text, double& value) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (result.ptr != end || result.ec == std::errc::invalid_argument) return false;
  if (result.ec == std::errc::result_out_of_range)
    value = std::strtod(std::string(text).c_str(), nullptr);
  return true;
}

}  // namespace

void fail_at(const PbrtPlace& place, const std::string& what) {
  // Names in a file may contain control characters, but a message is one line.
  std::string line = what;
  for (char& c : line)
    if (static_cast<unsigned char>(c) < 32) c = '?';
  throw InputError(place.file ? *place.file : std::string(), place.line, place.column, line);
}

std::string at_place(const PbrtPlace& place, const std::string& what) {
  return (place.file ? *place.file : std::string()) + ":" + std::to_string(place.line) + ":" +
         std::to_string(place.column) + ": " + what;
}

PbrtTokenizer::PbrtTokenizer(std::string file, std::string_view text)
    : file_(std::make_shared<const std::string>(std::move(file))), text_(text) {
  if (text_.starts_with("\xef\xbb\xbf")) at_ = line_start_ = 3;  // byte order mark
}

PbrtToken PbrtTokenizer::next() {
  if (!has_peeked_) return scan();
  has_peeked_ = false;
  return peeked_;
}

const PbrtToken& PbrtTokenizer::peek() {
  if (!has_peeked_) peeked_ = scan();
  has_peeked_ = true;
  return peeked_;
}

void PbrtTokenizer::skip_blanks() {
  for (; at_ < text_.size(); ++at_) {
    const char c = text_[at_];
    if (c == '#') {
      while (at_ < text_.size() && text_[at_] != '\n' && text_[at_] != '\r') ++at_;
      if (at_ == text_.size()) return;
    } else if (!is_pbrt_blank(c)) {
      return;
    }
    // A lone carriage return ends a line too; "\r\n" counts once.
    const bool ends_line =
        text_[at_] == '\n' ||
        (text_[at_] == '\r' && (at_ + 1 == text_.size() || text_[at_ + 1] != '\n'));
    if (ends_line) {
      ++line_;
      line_start_ = at_ + 1;
    }
  }
}

PbrtToken PbrtTokenizer::scan() {
  skip_blanks();
  PbrtToken token;
  token.line = line_;
  token.column = int(at_ - line_start_) + 1;
  if (at_ == text_.size()) return token;
  const char c = text_[at_];
  if (c == '"') return scan_string(token);
  if (c == '[' || c == ']') {
    token.kind = c == '[' ? PbrtTokenKind::open_bracket : PbrtTokenKind::close_bracket;
    token.text = text_.substr(at_++, 1);
    return token;
  }
  return scan_word(token);
}

PbrtToken PbrtTokenizer::scan_string(PbrtToken token) {
  token.kind = PbrtTokenKind::string;
  const size_t begin = ++at_;
  for (; at_ < text_.size() && text_[at_] != '"'; ++at_) {
    if (text_[at_] == '\n' || text_[at_] == '\r') break;
    if (text_[at_] == '\\' && at_ + 1 < text_.size() && text_[at_ + 1] != '\n') ++at_;
  }
  if (at_ >= text_.size() || text_[at_] != '"')
    fail_at(place(token), "string without closing quote");
  token.text = text_.substr(begin, at_ - begin);
  ++at_;
  return token;
}

PbrtToken PbrtTokenizer::scan_word(PbrtToken token) {
  const size_t begin = at_;
  while (at_ < text_.size() && !ends_word(text_[at_])) ++at_;
  if (at_ == begin) fail_at(place(token), "the file contains a zero byte");
  token.text = text_.substr(begin, at_ - begin);
  token.kind = PbrtTokenKind::word;
  const bool is_special = token.text == "nan" || token.text == "NaN" || token.text == "inf" ||
                          token.text == "Infinity" || token.text == "infinity";
  if (may_start_number(token.text[0]) || is_special) {
    token.kind = PbrtTokenKind::number;
    if (!parse_number(token.text, token.number))
      fail_at(place(token), "'" + std::string(token.text.substr(0, 40)) + "' is not a number");
  }
  return token;
}

std::string unescaped(std::string_view quoted) {
  std::string out;
  out.reserve(quoted.size());
  for (size_t i = 0; i < quoted.size(); ++i) {
    if (quoted[i] != '\\' || i + 1 == quoted.size()) {
      out += quoted[i];
      continue;
    }
    switch (const char c = quoted[++i]) {
      case 'n':
        out += '\n';
        break;
      case 't':
        out += '\t';
        break;
      case 'r':
        out += '\r';
        break;
      case 'b':
        out += '\b';
        break;
      case 'f':
        out += '\f';
        break;
      case '"':
      case '\'':
      case '\\':
        out += c;
        break;
      default:  // not an escape of pbrt: part of a Windows path
        out += '\\';
        out += c;
    }
  }
  return out;
}

}  // namespace troffer
