#include "lighting/csv_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

namespace troffer {

namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

// The sign among those that may part fields that occurs most, outside of quotes.
char separator_of(std::string_view line) {
  char best = ',';
  std::ptrdiff_t most = 0;
  for (const char c : {',', ';', '\t'}) {
    const std::ptrdiff_t n = std::count(line.begin(), line.end(), c);
    if (n > most) {
      most = n;
      best = c;
    }
  }
  return best;
}

}  // namespace

std::vector<std::string> fields_of_row(std::string_view line, char separator) {
  std::vector<std::string> fields{""};
  bool is_quoted = false, was_quoted = false;
  for (size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    std::string& field = fields.back();
    if (is_quoted) {
      const bool is_quote = c == '"', is_pair = is_quote && line.substr(i, 2) == "\"\"";
      is_quoted = !is_quote || is_pair;
      if (is_pair) ++i;
      if (is_quoted) field += c;
    } else if (c == separator) {
      if (!was_quoted)
        while (!field.empty() && is_blank(field.back())) field.pop_back();
      fields.emplace_back();
      was_quoted = false;
    } else if (c == '"' && field.empty()) {
      is_quoted = was_quoted = true;
    } else if (!(is_blank(c) && (field.empty() || was_quoted))) {
      field += c;
    }
  }
  if (!was_quoted)
    while (!fields.back().empty() && is_blank(fields.back().back())) fields.back().pop_back();
  return fields;
}

CsvTable read_csv(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // byte order mark
  CsvTable table;
  for (int line_number = 1; !text.empty(); ++line_number) {
    const size_t end = std::min(text.find_first_of("\r\n"), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(text.size(), end + (text.substr(end, 2) == "\r\n" ? 2 : 1)));
    const size_t first = line.find_first_not_of(" \t");
    if (first == line.npos || line[first] == '#') continue;
    const bool is_header = table.header.line == 0;
    if (is_header) table.separator = separator_of(line);
    CsvRow row{line_number, fields_of_row(line, table.separator)};
    if (!is_header) {
      table.rows.push_back(std::move(row));
      continue;
    }
    for (std::string& name : row.fields)
      for (char& c : name)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    table.header = std::move(row);
  }
  return table;
}

bool read_csv_number(const CsvTable& table, const std::string& field, double& value) {
  std::string plain = field;
  if (table.separator != ',') std::replace(plain.begin(), plain.end(), ',', '.');
  if (plain.size() > 1 && plain[0] == '+' && plain[1] != '-') plain.erase(0, 1);
  const char* const last = plain.data() + plain.size();
  const auto [stop, error] = std::from_chars(plain.data(), last, value);
  return error == std::errc() && stop == last && std::abs(value) <= 1e9;
}

}  // namespace troffer
