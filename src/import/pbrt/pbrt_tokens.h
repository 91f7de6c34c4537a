// Tokenizer of pbrt files: directives, quoted strings, numbers and brackets, each with its place.
// Used by all readers of this folder. Tokens refer to the text and do not copy it.
//
// References: [1] pbrt-v4 Input File Format, pbrt.org/fileformat-v4.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace troffer {

// A place in a file; line and column count from 1.
struct PbrtPlace {
  std::shared_ptr<const std::string> file;
  int line = 0, column = 0;
};

// Throws InputError.
[[noreturn]] void fail_at(const PbrtPlace& place, const std::string& what);
// Returns "FILE:LINE:COLUMN: what", for warnings that the user should be able to locate.
std::string at_place(const PbrtPlace& place, const std::string& what);

enum class PbrtTokenKind { end, word, string, number, open_bracket, close_bracket };

struct PbrtToken {
  PbrtTokenKind kind = PbrtTokenKind::end;
  std::string_view text;  // as in the file; of a string, the part between the quotes
  double number = 0;      // value of a number; infinite or NaN if the file says so
  int line = 0, column = 0;
};

class PbrtTokenizer {
 public:
  // `text` must outlive the tokenizer and its tokens.
  PbrtTokenizer(std::string file, std::string_view text);

  // Returns the next token; after the last one, always `end`. Throws InputError for unterminated
  // strings and malformed numbers.
  PbrtToken next();
  // Returns the next token without consuming it.
  const PbrtToken& peek();

  PbrtPlace place(const PbrtToken& token) const { return {file_, token.line, token.column}; }

 private:
  std::shared_ptr<const std::string> file_;
  std::string_view text_;
  size_t at_ = 0;
  size_t line_start_ = 0;
  int line_ = 1;
  bool has_peeked_ = false;
  PbrtToken peeked_;

  void skip_blanks();
  PbrtToken scan();
  PbrtToken scan_string(PbrtToken token);
  PbrtToken scan_word(PbrtToken token);
};

// Value of a quoted string, with backslash escapes replaced.
std::string unescaped(std::string_view quoted);

}  // namespace troffer
