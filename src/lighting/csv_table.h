// Tables as spreadsheets write them (RFC 4180): the one reader of lists of points, luminaires and
// surfaces. Columns are separated by commas, semicolons or tabs; fields stand in quotes where they
// hold such signs themselves, or line breaks. Lines end with "\n", "\r\n" or "\r". Empty lines,
// rows of empty fields, lines that begin with '#', a byte order mark and a first line "sep=;" are
// passed over.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace troffer {

// Fields of one line, without the blanks and quotes around them; within quotes two stand for one.
std::vector<std::string> fields_of_row(std::string_view line, char separator);

struct CsvRow {
  int line = 0;  // from 1, where it begins
  std::vector<std::string> fields;
  std::vector<int> columns;  // per field, where in its line its text begins, from 1
  int end_column = 1;        // behind the last field
};

// Reads a table row by row. Errors are InputErrors with line and column.
class CsvReader {
 public:
  // Reads the header, which tells the separator: the sign that occurs most in it. `text` must
  // outlive this.
  CsvReader(std::string path, std::string_view text);

  const CsvRow& header() const { return header_; }  // in lower case; line 0 where there is none
  bool next(CsvRow& row);                           // false at the end

  // Which field holds each of `names`; no_field where a column is missing that is not among the
  // first `needed`, which is an error, as is a name that occurs twice. `expected` is told then.
  std::vector<size_t> columns(std::span<const std::string_view> names, size_t needed,
                              const std::string& expected) const;
  static constexpr size_t no_field = size_t(-1);
  // Fields of the header that have a name which is not among `names`.
  std::vector<size_t> other_columns(std::span<const std::string_view> names) const;

  // A finite number of at most `most`, by magnitude; where columns are not separated by commas, a
  // comma may be its decimal point.
  double number(const CsvRow& row, size_t field, std::string_view name, double most) const;
  // A field's text; an error where the row ends before it.
  const std::string& text(const CsvRow& row, size_t field, std::string_view name) const;
  // At the field; where the row has fewer, behind its end.
  [[noreturn]] void fail(const CsvRow& row, size_t field, const std::string& what) const;

 private:
  bool take_row(CsvRow& row);
  void skip_break();

  std::string path_;
  std::string_view rest_;
  int line_ = 1;
  char separator_ = ',';
  CsvRow header_;
};

// "columns 'a' and 'b' of FILE are not used".
std::string unused_columns_note(const CsvReader& table, const std::string& path,
                                const std::vector<size_t>& fields);

}  // namespace troffer
