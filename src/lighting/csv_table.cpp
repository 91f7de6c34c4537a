#include "lighting/csv_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include "base/error.h"

namespace troffer {

namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

// Returns the separator that occurs most often outside quotes.
char separator_of(std::string_view line) {
  std::array<std::ptrdiff_t, 3> times{};
  constexpr std::array<char, 3> signs{',', ';', '\t'};
  bool is_quoted = false;
  for (const char c : line) {
    if (c == '"') is_quoted = !is_quoted;
    if (is_quoted) continue;
    for (size_t i = 0; i < signs.size(); ++i) times[i] += c == signs[i] ? 1 : 0;
  }
  return signs[size_t(std::max_element(times.begin(), times.end()) - times.begin())];
}

// Splits one row into fields.
class RowScanner {
 public:
  RowScanner(char separator, CsvRow& row) : separator_(separator), row_(row) {
    row_.fields.clear();
    row_.columns.clear();
    begin_field();
  }

  bool is_quoted() const { return is_quoted_; }
  // Takes the character `c`, which `next` follows. Returns true if it consumes `next` as well.
  bool take(char c, char next) {
    std::string& field = row_.fields.back();
    ++column_;
    if (is_quoted_) {
      const bool is_pair = c == '"' && next == '"';
      is_quoted_ = c != '"' || is_pair;
      if (is_quoted_) field += c;
      column_ += is_pair ? 1 : 0;
      return is_pair;
    }
    if (c == separator_) {
      end_field();
      begin_field();
    } else if (c == '"' && field.empty() && !was_quoted_) {
      is_quoted_ = was_quoted_ = true;
    } else if (!(is_blank(c) && (field.empty() || was_quoted_))) {
      field += c;
    } else if (field.empty() && !was_quoted_) {
      ++row_.columns.back();
    }
    return false;
  }
  void end() {
    end_field();
    row_.end_column = column_;
  }

 private:
  void begin_field() {
    row_.fields.emplace_back();
    row_.columns.push_back(column_);
    was_quoted_ = false;
  }
  void end_field() {
    std::string& field = row_.fields.back();
    if (!was_quoted_)
      while (!field.empty() && is_blank(field.back())) field.pop_back();
  }

  char separator_;
  CsvRow& row_;
  int column_ = 1;
  bool is_quoted_ = false, was_quoted_ = false;
};

}  // namespace

std::vector<std::string> fields_of_row(std::string_view line, char separator) {
  CsvRow row;
  RowScanner scanner(separator, row);
  for (size_t i = 0; i < line.size(); ++i)
    if (scanner.take(line[i], i + 1 < line.size() ? line[i + 1] : '\0')) ++i;
  scanner.end();
  return row.fields;
}

CsvReader::CsvReader(std::string path, std::string_view text)
    : path_(std::move(path)), rest_(text) {
  if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);  // byte order mark
  constexpr std::string_view mark = "sep=";
  bool has_separator = false;
  if (rest_.starts_with(mark) && rest_.size() > mark.size() &&
      std::string_view(",;\t").find(rest_[mark.size()]) != std::string_view::npos) {
    separator_ = rest_[mark.size()];
    has_separator = true;
    rest_.remove_prefix(std::min(rest_.find_first_of("\r\n"), rest_.size()));
    skip_break();
  }
  while (!rest_.empty()) {
    const std::string_view line = rest_.substr(0, rest_.find_first_of("\r\n"));
    const size_t first = line.find_first_not_of(" \t");
    if (!has_separator && first != line.npos && line[first] != '#') separator_ = separator_of(line);
    if (!take_row(header_)) continue;
    for (std::string& name : header_.fields)
      for (char& c : name)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return;
  }
  header_ = {};
}

bool CsvReader::next(CsvRow& row) {
  while (!rest_.empty())
    if (take_row(row)) return true;
  return false;
}

// Returns false if the line has nothing to read.
bool CsvReader::take_row(CsvRow& row) {
  const size_t line_end = std::min(rest_.find_first_of("\r\n"), rest_.size());
  const size_t first = rest_.substr(0, line_end).find_first_not_of(" \t");
  if (first == rest_.npos || rest_[first] == '#') {
    rest_.remove_prefix(line_end);
    skip_break();
    return false;
  }
  row.line = line_;
  RowScanner scanner(separator_, row);
  size_t i = 0;
  for (; i < rest_.size(); ++i) {
    const char c = rest_[i], next = i + 1 < rest_.size() ? rest_[i + 1] : '\0';
    const bool is_break = c == '\n' || c == '\r';
    if (is_break && !scanner.is_quoted()) break;
    if (is_break && !(c == '\r' && next == '\n')) ++line_;
    if (scanner.take(c, next)) ++i;
  }
  if (scanner.is_quoted()) throw InputError(path_, row.line, 1, "a quote is not closed");
  scanner.end();
  rest_.remove_prefix(i);
  skip_break();
  return std::any_of(row.fields.begin(), row.fields.end(),
                     [](const std::string& f) { return !f.empty(); });
}

void CsvReader::skip_break() {
  if (rest_.empty()) return;
  rest_.remove_prefix(rest_.starts_with("\r\n") ? 2 : 1);
  ++line_;
}

std::vector<size_t> CsvReader::columns(std::span<const std::string_view> names, size_t needed,
                                       const std::string& expected) const {
  const int line = std::max(header_.line, 1);
  std::vector<size_t> where;
  for (size_t n = 0; n < names.size(); ++n) {
    const auto& fields = header_.fields;
    const auto at = std::find(fields.begin(), fields.end(), names[n]);
    where.push_back(at == fields.end() ? no_field : size_t(at - fields.begin()));
    if (at == fields.end() && n < needed)
      throw InputError(path_, line, 1, fmt::format("{} lacks column '{}'", expected, names[n]));
    if (at != fields.end() && std::find(at + 1, fields.end(), names[n]) != fields.end())
      throw InputError(path_, line, 1, fmt::format("{} has column '{}' twice", expected, names[n]));
  }
  return where;
}

std::vector<size_t> CsvReader::other_columns(std::span<const std::string_view> names) const {
  std::vector<size_t> others;
  for (size_t f = 0; f < header_.fields.size(); ++f)
    if (!header_.fields[f].empty() &&
        std::find(names.begin(), names.end(), header_.fields[f]) == names.end())
      others.push_back(f);
  return others;
}

const std::string& CsvReader::text(const CsvRow& row, size_t field, std::string_view name) const {
  if (field >= row.fields.size()) fail(row, field, fmt::format("column '{}' is missing", name));
  return row.fields[field];
}

double CsvReader::number(const CsvRow& row, size_t field, std::string_view name,
                         double most) const {
  std::string plain = text(row, field, name);
  const bool has_comma = plain.find(',') != plain.npos;
  if (separator_ != ',') std::replace(plain.begin(), plain.end(), ',', '.');
  if (plain.size() > 1 && plain[0] == '+' && plain[1] != '-') plain.erase(0, 1);
  const char* const last = plain.data() + plain.size();
  double value = 0;
  const auto [stop, error] = std::from_chars(plain.data(), last, value);
  const bool is_number = stop == last && error != std::errc::invalid_argument && !std::isnan(value);
  if (is_number && (error == std::errc::result_out_of_range || std::abs(value) > most))
    fail(row, field,
         fmt::format("column '{}': '{}' is out of range", name, row.fields[field].substr(0, 40)));
  if (!is_number)
    fail(row, field,
         fmt::format("column '{}': '{}' is not a number{}", name, row.fields[field].substr(0, 40),
                     has_comma && separator_ == ','
                         ? " (with decimal commas, separate columns by semicolons)"
                         : ""));
  return value;
}

void CsvReader::fail(const CsvRow& row, size_t field, const std::string& what) const {
  throw InputError(path_, row.line,
                   field < row.columns.size() ? row.columns[field] : row.end_column, what);
}

std::string unused_columns_note(const CsvReader& table, const std::string& path,
                                const std::vector<size_t>& fields) {
  std::string names;
  for (size_t i = 0; i < fields.size(); ++i)
    names +=
        fmt::format("{}'{}'", i == 0 ? "" : ", ", table.header().fields[fields[i]].substr(0, 40));
  return fmt::format("column{} {} of {} {} not used", fields.size() == 1 ? "" : "s", names, path,
                     fields.size() == 1 ? "is" : "are");
}

}  // namespace troffer
