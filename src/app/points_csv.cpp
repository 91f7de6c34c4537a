#include "app/points_csv.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "base/error.h"
#include "import/file.h"
#include "lighting/csv_table.h"
#include "render/measurements_csv.h"

namespace troffer {

namespace {

constexpr std::array<std::string_view, 6> names{"x", "y", "z", "nx", "ny", "nz"};

MeasuringPoint point_of(const CsvReader& table, const CsvRow& row,
                        const std::vector<size_t>& where) {
  constexpr double largest = std::numeric_limits<float>::max();
  std::array<double, 6> v{};
  for (size_t n = 0; n < names.size(); ++n) v[n] = table.number(row, where[n], names[n], largest);
  const MeasuringPoint p{{v[0], v[1], v[2]}, Vec3(Vec3d{v[3], v[4], v[5]})};
  constexpr double farthest = 1e9;  // m; the limit for triangles of a scene, too
  const Vec3d reach = abs(p.position);
  if (std::max(reach.x, std::max(reach.y, reach.z)) > farthest)
    table.fail(row, where[0], "the point lies more than 1e9 from the origin");
  constexpr float shortest = 1e-15f;  // squares of shorter vectors lose digits
  const float l = length(p.normal);
  if (!(l >= shortest) || !std::isfinite(l))
    table.fail(row, where[3], "the normal has no direction");
  return p;
}

}  // namespace

std::string csv_field(const std::string& field) {
  if (field.find_first_of("\",\r\n") == field.npos) return field;
  std::string out = "\"";
  for (const char c : field) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

PointList read_points(const std::string& path) {
  const std::string text = read_text_or_pipe(path, uint64_t(1) << 30);
  CsvReader table(path, text);
  if (table.header().line == 0)
    throw InputError(path, 1, 1, "the header x,y,z,nx,ny,nz is missing");
  const std::vector<size_t> where = table.columns(names, names.size(), "the header x,y,z,nx,ny,nz");
  const std::vector<size_t> unused = table.other_columns(names);
  PointList list;
  if (!unused.empty()) list.note = unused_columns_note(table, path, unused);
  CsvRow row;
  while (table.next(row)) list.points.push_back(point_of(table, row, where));
  if (list.points.empty()) throw InputError(path, 0, 0, "lists no point");
  return list;
}

std::string measurements_csv(const PointList& list, const MeasureResult& result) {
  const std::string csv = measurements_csv(list.points, result);
  if (list.surfaces.empty()) return csv;
  std::string out;
  size_t begin = 0, next = 0;
  const auto take_line = [&](const std::string& more) {
    const size_t end = std::min(csv.find('\n', begin), csv.size());
    out.append(csv, begin, end - begin).append("," + more) += '\n';
    begin = std::min(end + 1, csv.size());
  };
  take_line("surface");
  for (; begin < csv.size(); ++next) {
    while (!result.is_measured[next]) ++next;
    take_line(csv_field(list.surfaces[next]));
  }
  return out;
}

}  // namespace troffer
