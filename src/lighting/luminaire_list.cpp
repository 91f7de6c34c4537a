#include "lighting/luminaire_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "import/file.h"
#include "import/kept_files.h"
#include "import/luminaire/attach_luminaire.h"
#include "import/reference_notes.h"
#include "lighting/attached_luminaires.h"
#include "lighting/csv_table.h"

namespace troffer {

namespace {

constexpr std::array<std::string_view, 11> columns{
    "file", "x", "y", "z", "dx", "dy", "dz", "rotation", "dimming", "lumens", "kelvin"};
constexpr size_t needed_columns = 4, most_rows = 100'000;
// length of a direction: the square of a much shorter one loses digits
constexpr double shortest = 1e-9;
constexpr double most_number = 1e9;

struct Row {
  std::string file;
  int line = 0;
  Vec3d position, down;
  double rotation_deg = 0, dimming = 1;
  double lumens = 0, kelvin = 0;  // 0: the file's flux; white
};

// Returns for each column the field of the table that holds it.
std::vector<size_t> read_header(const CsvReader& table, const std::string& path) {
  static constexpr const char* expected =
      "the header file,x,y,z[,dx,dy,dz][,rotation][,dimming][,lumens][,kelvin]";
  std::vector<size_t> where = table.columns(columns, needed_columns, expected);
  const auto given = std::count_if(where.begin() + 4, where.begin() + 7,
                                   [](size_t f) { return f != CsvReader::no_field; });
  if (given != 0 && given != 3)
    throw InputError(path, table.header().line, 1,
                     std::string(expected) + " lacks a part of the direction dx,dy,dz");
  return where;
}

// Parses a row. Empty or missing fields have the defaults of missing columns.
Row parse_row(const CsvReader& table, const CsvRow& source, const std::vector<size_t>& where,
              const Vec3& down) {
  std::array<double, columns.size()> v{0, 0, 0, 0, double(down.x), double(down.y), double(down.z),
                                       0, 1, 0, 0};
  Row row;
  row.line = source.line;
  const size_t names = table.header().fields.size();
  if (source.fields.size() > names)
    table.fail(source, names, fmt::format("{} columns expected", names));
  std::array<bool, columns.size()> has{};
  for (size_t i = 0; i < columns.size(); ++i) {
    has[i] = where[i] < source.fields.size() && !source.fields[where[i]].empty();
    if (!has[i] && i < needed_columns)
      table.fail(source, where[i], fmt::format("column '{}' is missing", columns[i]));
    if (!has[i]) continue;
    if (i == 0)
      row.file = source.fields[where[i]];
    else
      v[i] = table.number(source, where[i], columns[i], most_number);
  }
  if (has[4] != has[5] || has[5] != has[6])
    table.fail(source, where[4], "a direction needs three numbers");
  row.position = {v[1], v[2], v[3]};
  row.down = {v[4], v[5], v[6]};
  row.rotation_deg = v[7];
  row.dimming = v[8];
  row.lumens = v[9];
  row.kelvin = v[10];
  if (!(length(row.down) >= shortest)) table.fail(source, where[4], "the direction has no length");
  const auto check_range = [&](size_t column, double least, double most) {
    if (!(v[column] >= least && v[column] <= most))
      table.fail(source, where[column],
                 fmt::format("{} must lie between {} and {}", columns[column], least, most));
  };
  check_range(8, 0, 1e6);
  check_range(9, 0, 1e9);
  if (row.kelvin != 0) check_range(10, 1000, 40'000);
  return row;
}

// Returns a direction in the plane C0: x projected along the nadir (y if the nadir is along x),
// turned by the rotation.
Vec3d along_of(const Row& row) {
  const Vec3d axis = normalize(row.down);
  const Vec3d x = std::abs(axis.x) < 0.999 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d u = normalize(x - axis * dot(x, axis)), v = cross(axis, u);
  const double turn = rad_from_deg(row.rotation_deg);
  return u * std::cos(turn) + v * std::sin(turn);
}

std::vector<Row> read_rows(const std::string& path, const Vec3& down, WarningLog& warnings) {
  const std::string text = read_text_or_pipe(path, uint64_t(64) << 20);
  CsvReader table(path, text);
  const std::vector<size_t> where = read_header(table, path);
  const std::vector<size_t> unused = table.other_columns(columns);
  if (!unused.empty()) warnings.add(unused_columns_note(table, path, unused));
  std::vector<Row> rows;
  CsvRow row;
  while (table.next(row)) {
    if (rows.size() == most_rows) table.fail(row, 0, "too many luminaires");
    rows.push_back(parse_row(table, row, where, down));
  }
  if (rows.empty()) warnings.add(path + ": lists no luminaire");
  return rows;
}

// Reads a luminaire relative to the list's folder. Problems with its path are reported at the
// list's line.
Luminaire read_listed(const std::string& list, const Row& row, WarningLog& warnings) {
  const ReferenceNotes references;
  const ConfinedPath file = confined_path(folder_of(list), row.file);
  for (const std::string& note : references.notes()) warnings.add(note);
  std::error_code failure;
  const bool is_there =
      file.is_fine() && (KeptFiles::find(file.path) || std::filesystem::exists(file.path, failure));
  if (!is_there)
    throw InputError(list, row.line, 1,
                     fmt::format("file '{}': {}", row.file.substr(0, 200),
                                 file.is_fine() ? "no such file" : file.problem));
  return read_and_check_luminaire(file.path, warnings);
}

}  // namespace

void add_luminaire_list(Scene& scene, const std::string& path, const Vec3& down) {
  struct Known {
    Luminaire luminaire;
    int32_t web;
  };
  std::map<std::string, Known> known;
  size_t n = 0;
  for (const Row& row : read_rows(path, down, scene.warnings)) {
    auto at = known.find(row.file);
    if (at == known.end()) {
      at = known.emplace(row.file, Known{read_listed(path, row, scene.warnings), 0}).first;
      at->second.web = add_web(scene, at->second.luminaire);
    }
    const std::string name = "luminaire" + std::to_string(n++);
    if (row.dimming > 0)
      add_luminaire(scene, name, at->second.luminaire, at->second.web,
                    luminaire_scale(scene, at->second.luminaire, row.file, row.lumens, row.kelvin) *
                        float(row.dimming),
                    {row.position - scene.origin, row.down, along_of(row), Vec3d(down)});
  }
}

std::vector<double> watts_of_luminaire_list(const std::string& path, const Vec3& down) {
  std::map<std::string, double> known;
  std::vector<double> watts;
  WarningLog ignored;  // warnings are issued when the luminaires are added
  for (const Row& row : read_rows(path, down, ignored)) {
    auto at = known.find(row.file);
    if (at == known.end())
      at = known.emplace(row.file, read_listed(path, row, ignored).watts).first;
    watts.push_back(at->second * row.dimming);
  }
  return watts;
}

}  // namespace troffer
