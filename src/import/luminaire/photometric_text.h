// Numbers and lines of photometric files, which many programs have written in many ways.
#pragma once

#include <string>
#include <string_view>

#include "base/log.h"

namespace troffer {

// Without blanks at its ends.
std::string_view trimmed(std::string_view s);

// Takes a text apart into lines, and lines into numbers. Lines end with "\n", "\r\n" or "\r".
// Commas are separators between numbers, or points where they are said to be, and points within a
// number that has a line of its own.
class PhotometricText {
 public:
  // Both must outlive this.
  PhotometricText(const std::string& file, std::string_view text, bool are_commas_decimal = false)
      : file_(file), text_(text), are_commas_decimal_(are_commas_decimal) {}

  // The next line without blanks and line ends around it; false at the end.
  bool next_line(std::string_view& line);
  // The next number, of this line or a later one, within [least, most]; `name` is for messages.
  double number(const char* name, double least, double most);
  int integer(const char* name, int least, int most);
  // One number that has a line of its own; what follows it there is left aside. An empty line is 0.
  double number_of_line(const char* name, double least, double most);
  int integer_of_line(const char* name, int least, int most);

  bool has_met_decimal_commas() const { return has_met_commas_; }
  // At the number or line read last.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  double parse(std::string_view word, const char* name, double least, double most);
  std::string_view take_line();
  // Behind the end of a line that stands there.
  size_t after_break(size_t at) const;
  bool is_separator(size_t at) const;

  const std::string& file_;
  std::string_view text_;
  size_t next_ = 0;               // offset of what is not read
  size_t line_ = 0, column_ = 1;  // of what was read last; lines from 1
  size_t line_start_ = 0;
  bool is_in_line_ = false, has_met_commas_ = false, are_commas_decimal_ = false;
};

}  // namespace troffer
