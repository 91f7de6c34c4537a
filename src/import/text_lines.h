// Text files of one statement per line, word by word: what OBJ and MTL share.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace troffer {

// The text as UTF-8: from UTF-16 where it has a byte order mark; from Latin-1 where it is no UTF-8.
std::string as_utf8(std::string_view text);
// Whether it is that already.
bool is_utf8(std::string_view text);

// Consecutive pieces of a text of about so many bytes, each of whole statements: cut behind a "\n"
// that no backslash joins with the next line, and only where that begins with `first` ("": any).
// They view the text.
std::vector<std::string_view> cut_at_lines(std::string_view text, size_t piece_bytes,
                                           std::string_view first = "");

// Appends a code point.
void append_utf8(std::string& out, uint32_t code_point);

// Takes lines apart. A backslash at the end of a line joins it with the next one; lines end with
// "\n", "\r\n" or "\r".
class TextLines {
 public:
  // Both must outlive this. is_whole: the text begins where its file does; else it is told as if it
  // came after lines_before lines.
  TextLines(const std::string& file, std::string_view text, bool is_whole = true,
            int lines_before = 0);

  // Goes to the next line; false at the end.
  bool next_line();

  // The next word of the line, "" at its end. A word that begins with '#' begins a comment.
  std::string_view word();
  // All that is left of the line, without blanks around it; '#' counts as text within it.
  std::string_view rest();
  // Whether a word follows.
  bool has_word();

  // A number: InputError where there is none. May be NaN or infinite.
  float number();
  double precise_number();  // the same, not rounded to float
  // An integer, read up to the first other character; false where there is none or it does not
  // fit 32 bits.
  bool integer(int& value);
  // The next character, 0 at the end of the line; take() goes past it.
  char peek() const { return at_ < end_ ? *at_ : '\0'; }
  void take() { ++at_; }

  // Line and column, from 1, of the word read last.
  int line() const { return line_; }
  int column() const { return int(word_ - begin_) + 1; }
  [[noreturn]] void fail(const std::string& what) const;
  // How many lines have been gone to, those that others are joined with included.
  int lines_taken() const { return next_line_number_ - 1 - lines_before_; }

 private:
  const std::string& file_;
  std::string_view text_;
  size_t next_ = 0;  // offset of the next line
  int lines_before_, line_ = 0, next_line_number_;
  std::string joined_;
  const char *begin_ = nullptr, *at_ = nullptr, *end_ = nullptr, *word_ = nullptr;

  std::string_view take_physical_line();
  void skip_blanks();
  template <class Real>
  Real read_number();
};

}  // namespace troffer
