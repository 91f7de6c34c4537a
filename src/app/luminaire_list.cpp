#include "app/luminaire_list.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "import/attach_luminaire.h"
#include "import/file.h"

namespace troffer {

namespace {

constexpr std::array<std::string_view, 9> columns{"file", "x",  "y",        "z",      "dx",
                                                  "dy",   "dz", "rotation", "dimming"};
constexpr size_t least_columns = 4, most_rows = 100'000;

struct Row {
  std::string file;
  Vec3d position, down;
  double rotation_deg = 0, dimming = 1;
};

std::vector<std::string> fields_of(std::string_view line) {
  std::vector<std::string> fields{""};
  for (const char c : line) {
    if (c == ',')
      fields.emplace_back();
    else if (c != '\r' && !(c == ' ' && fields.back().empty()))
      fields.back() += c;
  }
  return fields;
}

double number(const std::string& text, const std::string& path, int line, size_t column) {
  char* end = nullptr;
  const double v = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(std::abs(v) <= 1e9))
    throw InputError(path, line, 1,
                     fmt::format("column '{}': '{}' is not a number", columns[column], text));
  return v;
}

Row parse_row(const std::vector<std::string>& fields, size_t expected, const std::string& path,
              int line, const Vec3& down) {
  if (fields.size() != expected)
    throw InputError(path, line, 1, fmt::format("{} columns expected", expected));
  std::array<double, columns.size()> v{0, 0, 0, 0, double(down.x), double(down.y), double(down.z),
                                       0, 1};
  for (size_t i = 1; i < fields.size(); ++i) v[i] = number(fields[i], path, line, i);
  Row row{fields[0], {v[1], v[2], v[3]}, {v[4], v[5], v[6]}, v[7], v[8]};
  if (!(length(row.down) > 0)) throw InputError(path, line, 1, "the direction has no length");
  if (!(row.dimming >= 0 && row.dimming <= 1e6))
    throw InputError(path, line, 1, "dimming must lie between 0 and 1e6");
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
  const std::string text = read_text_file(path, uint64_t(64) << 20);
  std::string_view rest = text;
  if (rest.starts_with("\xef\xbb\xbf")) rest.remove_prefix(3);  // byte order mark
  std::vector<Row> rows;
  size_t expected = 0;
  for (int line = 1; !rest.empty(); ++line) {
    const size_t end = rest.find('\n');
    const auto fields = fields_of(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (fields.size() == 1 && fields[0].empty()) continue;
    if (expected == 0) {
      expected = fields.size();
      bool is_header = expected >= least_columns && expected <= columns.size();
      for (size_t i = 0; is_header && i < expected; ++i) is_header = fields[i] == columns[i];
      if (!is_header)
        throw InputError(path, line, 1,
                         "the header must be file,x,y,z[,dx,dy,dz[,rotation[,dimming]]]");
      continue;
    }
    if (rows.size() >= most_rows) throw InputError(path, line, 1, "too many luminaires");
    rows.push_back(parse_row(fields, expected, path, line, down));
  }
  return rows;
}

}  // namespace

void add_luminaire_list(Scene& scene, const std::string& path, const Vec3& down) {
  struct Known {
    Luminaire luminaire;
    int32_t web;
  };
  std::map<std::string, Known> known;
  const auto folder = std::filesystem::path(path).parent_path();
  const double unit = scene.is_photometric ? 1 : 1 / luminous_efficacy;
  size_t n = 0;
  for (const Row& row : read_rows(path, down)) {
    auto at = known.find(row.file);
    if (at == known.end()) {
      at = known
               .emplace(row.file,
                        Known{read_luminaire((folder / row.file).string(), scene.warnings), 0})
               .first;
      at->second.web = add_web(scene, at->second.luminaire);
    }
    const std::string name = "luminaire" + std::to_string(n++);
    if (row.dimming > 0)
      add_luminaire(scene, name, at->second.luminaire, at->second.web,
                    Rgb{float(unit * row.dimming)},
                    {row.position - scene.origin, row.down, along_of(row), Vec3d(down)});
  }
}

}  // namespace troffer
