#include "import/json_location.h"

#include <cstdint>
#include <optional>
#include <string>

#include "import/text_lines.h"

namespace troffer {

namespace {

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

uint32_t hex4(std::string_view digits) {
  uint32_t value = 0;
  for (const char c : digits) {
    const int d = c >= '0' && c <= '9'   ? c - '0'
                  : c >= 'a' && c <= 'f' ? c - 'a' + 10
                  : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                         : 0;
    value = value * 16 + uint32_t(d);
  }
  return value;
}

// Decodes the escapes of a JSON string without its quotes [2] §7.
std::string json_unescaped(std::string_view raw) {
  std::string out;
  for (size_t i = 0; i < raw.size(); ++i) {
    if (raw[i] != '\\' || i + 1 >= raw.size()) {
      out += raw[i];
      continue;
    }
    const char c = raw[++i];
    if (c == 'u') {
      uint32_t code = hex4(raw.substr(i + 1, 4));
      i += 4;
      if (code >= 0xd800 && code < 0xdc00 && raw.substr(i + 1, 2) == "\\u") {
        code = 0x10000 + ((code - 0xd800) << 10) + (hex4(raw.substr(i + 3, 4)) - 0xdc00);
        i += 6;
      }
      append_utf8(out, code);
    } else {
      out += c == 'n'   ? '\n'
             : c == 't' ? '\t'
             : c == 'r' ? '\r'
             : c == 'b' ? '\b'
             : c == 'f' ? '\f'
                        : c;
    }
  }
  return out;
}

// A cursor over well-formed JSON. On other text it stops early but never leaves the text.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) { skip_space(); }
  size_t at() const { return at_; }

  // Moves from the start of a container to the value of the named member or element. Returns false,
  // without moving, if there is none.
  bool enter(std::string_view token) {
    const size_t start = at_;
    std::optional<size_t> found;
    if (peek() == '{')
      found = find_member(token);
    else if (peek() == '[')
      found = find_element(token);
    at_ = found.value_or(start);
    return found.has_value();
  }

 private:
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void skip_space() {
    while (at_ < text_.size() && is_space(text_[at_])) ++at_;
  }
  // Reads the string at the cursor, without its quotes.
  std::string_view read_string() {
    const size_t first = ++at_;
    while (at_ < text_.size() && text_[at_] != '"') at_ += text_[at_] == '\\' ? 2 : 1;
    const size_t last = std::min(at_, text_.size());
    at_ = std::min(last + 1, text_.size());
    return text_.substr(first, last - first);
  }
  // Moves past the value at the cursor. Counts brackets instead of recursing.
  void skip_value() {
    size_t depth = 0;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"') {
        read_string();
      } else if (c == '{' || c == '[') {
        ++depth;
        ++at_;
        continue;
      } else if (c == '}' || c == ']') {
        if (depth == 0) return;
        --depth;
        ++at_;
      } else if (depth == 0 && c == ',') {
        return;
      } else {
        ++at_;
        if (depth > 0 || (at_ < text_.size() && !is_space(text_[at_]) && text_[at_] != ',' &&
                          text_[at_] != '}' && text_[at_] != ']'))
          continue;
      }
      if (depth == 0) return;
    }
  }
  // Moves from the end of a value to the next member or element; false if there is none.
  bool next() {
    skip_space();
    if (peek() != ',') return false;
    ++at_;
    skip_space();
    return true;
  }
  std::optional<size_t> find_member(std::string_view key) {
    std::optional<size_t> found;
    ++at_;
    skip_space();
    do {
      if (peek() != '"') break;
      const std::string_view raw = read_string();
      skip_space();
      if (peek() == ':') ++at_;
      skip_space();
      const bool is_it =
          raw.find('\\') == std::string_view::npos ? raw == key : json_unescaped(raw) == key;
      if (is_it) found = at_;
      skip_value();
    } while (next());
    return found;
  }
  std::optional<size_t> find_element(std::string_view token) {
    size_t wanted = 0;
    for (const char c : token) {
      if (c < '0' || c > '9' || wanted > text_.size()) return std::nullopt;
      wanted = wanted * 10 + size_t(c - '0');
    }
    ++at_;
    skip_space();
    if (peek() == ']') return std::nullopt;
    for (size_t i = 0; i < wanted; ++i) {
      skip_value();
      if (!next()) return std::nullopt;
    }
    return at_;
  }

  std::string_view text_;
  size_t at_ = 0;
};

// Decodes one reference token of a pointer: ~1 is '/', ~0 is '~' [1] §4.
std::string unescaped_token(std::string_view token) {
  std::string out;
  for (size_t i = 0; i < token.size(); ++i) {
    if (token[i] == '~' && i + 1 < token.size())
      out += token[++i] == '1' ? '/' : '~';
    else
      out += token[i];
  }
  return out;
}

}  // namespace

TextPosition position_of_offset(std::string_view text, size_t offset) {
  TextPosition p;
  for (size_t i = 0; i < std::min(offset, text.size()); ++i) {
    if (text[i] == '\n') {
      ++p.line;
      p.column = 1;
    } else {
      ++p.column;
    }
  }
  return p;
}

TextPosition position_of_json_value(std::string_view text, std::string_view pointer) {
  Scanner scanner(text);
  while (!pointer.empty()) {
    pointer.remove_prefix(1);  // '/'
    const size_t end = std::min(pointer.find('/'), pointer.size());
    if (!scanner.enter(unescaped_token(pointer.substr(0, end)))) break;
    pointer.remove_prefix(end);
  }
  return position_of_offset(text, scanner.at());
}

}  // namespace troffer
