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
#include "import/attach_luminaire.h"
#include "import/file.h"
#include "lighting/attached_luminaires.h"
#include "lighting/csv_table.h"

namespace troffer {

namespace {

constexpr std::array<std::string_view, 11> columns{
    "file", "x", "y", "z", "dx", "dy", "dz", "rotation", "dimming", "lumens", "kelvin"};
constexpr size_t needed_columns = 4, most_rows = 100'000;
constexpr double shortest = 1e-9;  // of a direction: squares of much less lose digits

struct Row {
  std::string file;
  int line = 0;
  Vec3d position, down;
  double rotation_deg = 0, dimming = 1;
  double lumens = 0, kelvin = 0;  // 0: the file's; white
};

// Per field of the table, which of `columns` it is.
std::vector<size_t> read_header(const CsvTable& table, const std::string& path) {
  static constexpr const char* expected =
      "the header must be file,x,y,z[,dx,dy,dz][,rotation][,dimming][,lumens][,kelvin], in any "
      "order";
  std::vector<size_t> which;
  std::array<int, columns.size()> times{};
  for (const std::string& name : table.header.fields) {
    const auto at = size_t(std::find(columns.begin(), columns.end(), name) - columns.begin());
    which.push_back(at);
    if (name.empty()) continue;
    if (at == columns.size())
      throw InputError(path, table.header.line, 1,
                       fmt::format("column '{}' is not known; {}", name.substr(0, 40), expected));
    ++times[at];
  }
  const bool has_direction = times[4] + times[5] + times[6] == 3;
  const bool has_none = times[4] + times[5] + times[6] == 0;
  for (size_t i = 0; i < columns.size(); ++i)
    if (times[i] > 1 || (times[i] == 0 && i < needed_columns) || !(has_direction || has_none))
      throw InputError(path, std::max(table.header.line, 1), 1, expected);
  return which;
}

void check_range(double v, double least, double most, const std::string& path, int line,
                 const char* what) {
  if (!(v >= least && v <= most))
    throw InputError(path, line, 1,
                     fmt::format("{} must lie between {} and {}", what, least, most));
}

// Fields that are empty, or left off at the end, are what the columns' absence means.
Row parse_row(const CsvTable& table, const CsvRow& source, const std::vector<size_t>& which,
              const std::string& path, const Vec3& down) {
  std::array<double, columns.size()> v{0, 0, 0, 0, double(down.x), double(down.y), double(down.z),
                                       0, 1, 0, 0};
  Row row;
  row.line = source.line;
  if (source.fields.size() > which.size())
    throw InputError(path, row.line, 1, fmt::format("{} columns expected", which.size()));
  std::array<bool, columns.size()> has{};
  for (size_t i = 0; i < source.fields.size(); ++i) {
    const std::string& field = source.fields[i];
    if (field.empty() || which[i] == columns.size()) continue;
    has[which[i]] = true;
    if (which[i] == 0)
      row.file = field;
    else if (!read_csv_number(table, field, v[which[i]]))
      throw InputError(
          path, row.line, 1,
          fmt::format("column '{}': '{}' is not a number", columns[which[i]], field.substr(0, 40)));
  }
  for (size_t i = 0; i < needed_columns; ++i)
    if (!has[i])
      throw InputError(path, row.line, 1, fmt::format("column '{}' is missing", columns[i]));
  if (has[4] != has[5] || has[5] != has[6])
    throw InputError(path, row.line, 1, "a direction has three numbers");
  row.position = {v[1], v[2], v[3]};
  row.down = {v[4], v[5], v[6]};
  row.rotation_deg = v[7];
  row.dimming = v[8];
  row.lumens = v[9];
  row.kelvin = v[10];
  if (!(length(row.down) >= shortest))
    throw InputError(path, row.line, 1, "the direction has no length");
  check_range(row.dimming, 0, 1e6, path, row.line, "dimming");
  check_range(row.lumens, 0, 1e9, path, row.line, "lumens");
  if (row.kelvin != 0) check_range(row.kelvin, 1000, 40'000, path, row.line, "kelvin");
  return row;
}

// In the plane C0: as near to x as the nadir allows (y where that is x itself), turned about it.
Vec3d along_of(const Row& row) {
  const Vec3d axis = normalize(row.down);
  const Vec3d x = std::abs(axis.x) < 0.999 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d u = normalize(x - axis * dot(x, axis)), v = cross(axis, u);
  const double turn = rad_from_deg(row.rotation_deg);
  return u * std::cos(turn) + v * std::sin(turn);
}

std::vector<Row> read_rows(const std::string& path, const Vec3& down) {
  const CsvTable table = read_csv(read_text_file(path, uint64_t(64) << 20));
  const std::vector<size_t> which = read_header(table, path);
  if (table.rows.size() > most_rows)
    throw InputError(path, table.rows[most_rows].line, 1, "too many luminaires");
  std::vector<Row> rows;
  for (const CsvRow& row : table.rows) rows.push_back(parse_row(table, row, which, path, down));
  return rows;
}

// From the list's folder; what is wrong with its path is told of the list.
Luminaire read_listed(const std::string& list, const Row& row, WarningLog& warnings) {
  const ConfinedPath file = confined_path(folder_of(list), row.file);
  std::error_code failure;
  const bool is_there = file.is_fine() && std::filesystem::exists(file.path, failure);
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
  for (const Row& row : read_rows(path, down)) {
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
  WarningLog ignored;  // told when the luminaires are added
  for (const Row& row : read_rows(path, down)) {
    auto at = known.find(row.file);
    if (at == known.end())
      at = known.emplace(row.file, read_listed(path, row, ignored).watts).first;
    watts.push_back(at->second);
  }
  return watts;
}

}  // namespace troffer
