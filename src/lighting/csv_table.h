// Tables as text, as spreadsheets write them: rows of fields parted by commas, semicolons or tabs,
// in quotes where they hold such signs themselves (RFC 4180).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace troffer {

// Fields of a row, without blanks and quotes around them; within quotes two stand for one.
std::vector<std::string> fields_of_row(std::string_view line, char separator);

struct CsvRow {
  int line = 0;  // from 1
  std::vector<std::string> fields;
};

// A header and rows. What parts fields is seen by the header; where that is no comma, commas within
// numbers may be decimal ones.
struct CsvTable {
  char separator = ',';
  CsvRow header;  // in lower case
  std::vector<CsvRow> rows;
};

// Lines end with "\n", "\r\n" or "\r"; empty ones and those that begin with '#' are left out, and
// so is a byte order mark.
CsvTable read_csv(std::string_view text);

// A number of at most 1e9; where the table's separator is no comma, a comma may be its point. False
// for what is none.
bool read_csv_number(const CsvTable& table, const std::string& field, double& value);

}  // namespace troffer
