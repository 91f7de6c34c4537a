// Reads tables as spreadsheets write them (RFC 4180), for lists of points, luminaires and surfaces.
// Columns are separated by commas, semicolons or tabs. Fields that contain separators or line
// breaks are quoted. Lines end with "\n", "\r\n" or "\r". The reader skips empty lines, rows of
// empty fields, lines that begin with '#', a byte order mark and a first line "sep=;".
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace troffer {

// Returns the fields of one line without surrounding blanks and quotes. Inside quotes, "" stands
// for one quote.
std::vector<std::string> fields_of_row(std::string_view line, char separator);

struct CsvRow {
  int line = 0;  // first line of the row, from 1
  std::vector<std::string> fields;
  std::vector<int> columns;  // per field: column where its text begins, from 1
  int end_column = 1;        // column after the last field
};

// Reads a table row by row. Throws InputError with line and column.
class CsvReader {
 public:
  // Reads the header. The separator is the one that occurs most often in it. `text` must outlive
  // the reader.
  CsvReader(std::string path, std::string_view text);

  const CsvRow& header() const { return header_; }  // in lower case; line 0: no header
  bool next(CsvRow& row);                           // false at the end

  // Returns the field index of each of `names`, or no_field if the column is missing. Throws if one
  // of the first `needed` columns is missing or a name occurs twice; `expected` is part of the
  // message.
  std::vector<size_t> columns(std::span<const std::string_view> names, size_t needed,
                              const std::string& expected) const;
  static constexpr size_t no_field = size_t(-1);
  // Returns the named header fields that are not among `names`.
  std::vector<size_t> other_columns(std::span<const std::string_view> names) const;

  // Returns a finite number of magnitude `most` or less. A decimal comma is allowed unless commas
  // separate columns.
  double number(const CsvRow& row, size_t field, std::string_view name, double most) const;
  // Returns a field's text. Throws if the row has no such field.
  const std::string& text(const CsvRow& row, size_t field, std::string_view name) const;
  // Throws an InputError at the field, or at the end of the row if it has fewer fields.
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

// Returns "columns 'a' and 'b' of FILE are not used".
std::string unused_columns_note(const CsvReader& table, const std::string& path,
                                const std::vector<size_t>& fields);

}  // namespace troffer
