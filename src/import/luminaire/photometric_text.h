// Tokenizer of photometric files: lines and numbers, in the many variants that programs write. The
// readers of LM-63 and EULUMDAT use it. Errors are InputError with the line and column of the last
// item read.
#pragma once

#include <string>
#include <string_view>

#include "base/log.h"

namespace troffer {

// Returns `s` without blanks at its ends.
std::string_view trimmed(std::string_view s);

// Splits a text into lines and numbers. Lines end with "\n", "\r\n" or "\r". A comma separates
// numbers; it is a decimal point if `are_commas_decimal` says so, and always in a number on a line
// of its own.
class PhotometricText {
 public:
  // Both must outlive this object.
  PhotometricText(const std::string& file, std::string_view text, bool are_commas_decimal = false)
      : file_(file), text_(text), are_commas_decimal_(are_commas_decimal) {}

  // Reads the next line, without surrounding blanks; false at the end of the text.
  bool next_line(std::string_view& line);
  // Returns the next number, on this line or a later one. Throws InputError unless it lies within
  // [least, most]; `name` is for messages.
  double number(const char* name, double least, double most);
  int integer(const char* name, int least, int most);
  // Returns the number at the start of the next line and ignores the rest of that line. An empty
  // line means 0, clamped to [least, most].
  double number_of_line(const char* name, double least, double most);
  int integer_of_line(const char* name, int least, int most);

  bool has_met_decimal_commas() const { return has_met_commas_; }
  // Throws InputError at the number or line read last.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  double parse(std::string_view word, const char* name, double least, double most);
  std::string_view take_line();
  // Returns the offset after the line end at `at`.
  size_t after_break(size_t at) const;
  bool is_separator(size_t at) const;

  const std::string& file_;
  std::string_view text_;
  size_t next_ = 0;               // offset of the first unread byte
  size_t line_ = 0, column_ = 1;  // place of the item read last, from 1
  size_t line_start_ = 0;
  bool is_in_line_ = false, has_met_commas_ = false, are_commas_decimal_ = false;
};

}  // namespace troffer
