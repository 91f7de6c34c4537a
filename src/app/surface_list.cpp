#include "app/surface_list.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string_view>

#include "base/error.h"
#include "import/file.h"
#include "lighting/csv_table.h"

namespace troffer {

namespace {

constexpr std::array<std::string_view, 14> surface_columns{
    "node", "name", "profile", "lift", "border", "x", "y", "z", "ax", "ay", "az", "bx", "by", "bz"};
constexpr size_t first_number = 3, first_of_rectangle = 5, most_rows = 1000;
constexpr double most_coordinate = 1e9, longest_side = 1e5, most_lift = 1e3;  // m

// Fields of a row. Empty fields count as missing columns.
struct Fields {
  std::array<std::string, first_number> texts;
  std::array<double, surface_columns.size()> numbers{};
  std::array<bool, surface_columns.size()> has{};
};

Fields fields_of(const CsvReader& table, const CsvRow& row, const std::vector<size_t>& where) {
  Fields f;
  f.numbers[4] = -1;  // no border
  for (size_t i = 0; i < surface_columns.size(); ++i) {
    f.has[i] = where[i] < row.fields.size() && !row.fields[where[i]].empty();
    if (!f.has[i]) continue;
    if (i < first_number)
      f.texts[i] = row.fields[where[i]].substr(0, 200);
    else
      f.numbers[i] = table.number(row, where[i], surface_columns[i], most_coordinate);
  }
  return f;
}

SurfaceRequest surface_of(const CsvReader& table, const CsvRow& row,
                          const std::vector<size_t>& where) {
  const Fields f = fields_of(table, row, where);
  const auto& v = f.numbers;
  SurfaceRequest r;
  r.node = f.texts[0];
  r.name = f.texts[1];
  r.profile = f.texts[2];
  r.lift = v[3];
  r.border = v[4];
  if (std::abs(r.lift) > most_lift)
    table.fail(row, where[3], "lift must lie between -1000 and 1000");
  if (f.has[4] && !(r.border >= 0 && r.border <= most_lift))
    table.fail(row, where[4], "border must lie between 0 and 1000");
  size_t given = 0;
  for (size_t i = first_of_rectangle; i < surface_columns.size(); ++i) given += f.has[i] ? 1 : 0;
  if (!r.node.empty()) {
    if (given > 0) table.fail(row, where[0], "a surface needs a node or a rectangle, not both");
    return r;
  }
  for (size_t i = first_of_rectangle; i < surface_columns.size(); ++i)
    if (!f.has[i])
      table.fail(row, where[i],
                 fmt::format("neither a node nor a whole rectangle: column '{}' is missing",
                             surface_columns[i]));
  r.corner = {v[5], v[6], v[7]};
  r.side_a = {v[8], v[9], v[10]};
  r.side_b = {v[11], v[12], v[13]};
  const double a = length(r.side_a), b = length(r.side_b);
  if (!(a > 0 && b > 0 && a <= longest_side && b <= longest_side) ||
      std::abs(dot(r.side_a, r.side_b)) > 1e-3 * a * b)
    table.fail(row, where[8], "the sides must be at right angles, and between 0 and 100 km long");
  return r;
}

}  // namespace

void read_surface_list(const std::string& path, AssessmentOptions& options) {
  const std::string text = read_text_or_pipe(path, uint64_t(16) << 20);
  CsvReader table(path, text);
  const std::vector<size_t> where =
      table.columns(surface_columns, 0, "the header node[,name][,profile][,lift][,border]");
  if (where[0] == CsvReader::no_field && where[5] == CsvReader::no_field)
    throw InputError(path, table.header().line, 1, "the header has neither node nor x,y,z");
  const std::vector<size_t> unused = table.other_columns(surface_columns);
  if (!unused.empty()) options.notes.push_back(unused_columns_note(table, path, unused));
  CsvRow row;
  size_t rows = 0;
  while (table.next(row)) {
    if (++rows > most_rows) table.fail(row, 0, "more than 1000 surfaces");
    options.surfaces.push_back(surface_of(table, row, where));
  }
  if (rows == 0) throw InputError(path, 0, 0, "lists no surface");
}

}  // namespace troffer
