// Reader of text files with one statement per line, word by word. The readers of OBJ, MTL and text
// STL share it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace troffer {

// Converts text to UTF-8: from UTF-16 if it has a byte order mark, from Latin-1 if it is not valid
// UTF-8.
std::string as_utf8(std::string_view text);
// True if the text is UTF-8 already.
bool is_utf8(std::string_view text);

// Cuts a text into consecutive pieces of about `piece_bytes`, each of whole statements. Cuts only
// after a "\n" that no backslash joins with the next line, and only before a line that begins with
// `first` ("": any). The pieces are views of the text.
std::vector<std::string_view> cut_at_lines(std::string_view text, size_t piece_bytes,
                                           std::string_view first = "");

// Appends a code point.
void append_utf8(std::string& out, uint32_t code_point);

// Splits text into lines and words. A backslash at the end of a line joins it with the next one.
// Lines end with "\n", "\r\n" or "\r".
class TextLines {
 public:
  // Both must outlive this object. `is_whole`: the text begins where its file does, perhaps with a
  // byte order mark. `lines_before` is added to line numbers.
  TextLines(const std::string& file, std::string_view text, bool is_whole = true,
            int lines_before = 0);

  // Moves to the next line; false at the end.
  bool next_line();

  // Returns the next word of the line; "" at its end. A word that begins with '#' starts a comment.
  std::string_view word();
  // Returns the rest of the line without surrounding blanks; '#' counts as text.
  std::string_view rest();
  // True if another word follows.
  bool has_word();

  // Reads a number, which may be NaN or infinite. Throws InputError if there is none.
  float number();
  double precise_number();  // in double precision
  // Reads an integer up to the first other character. Returns false if there is none or it exceeds
  // 32 bits.
  bool integer(int& value);
  // Next character; 0 at the end of the line. take() moves past it.
  char peek() const { return at_ < end_ ? *at_ : '\0'; }
  void take() { ++at_; }

  // Line and column, from 1, of the word read last.
  int line() const { return line_; }
  int column() const { return int(word_ - begin_) + 1; }
  [[noreturn]] void fail(const std::string& what) const;
  // Number of lines read, joined ones included.
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
