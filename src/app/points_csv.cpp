#include "app/points_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "base/error.h"
#include "import/file.h"

namespace troffer {

namespace {

struct Field {
  std::string_view text;
  int column;
};

std::string_view trimmed(std::string_view s) {
  while (!s.empty() && (s.front() == ' ' || s.front() == '\t')) s.remove_prefix(1);
  while (!s.empty() && (s.back() == ' ' || s.back() == '\t' || s.back() == '\r'))
    s.remove_suffix(1);
  if (s.size() >= 2 && s.front() == '"' && s.back() == '"') s = s.substr(1, s.size() - 2);
  return s;
}

std::vector<Field> fields_of(std::string_view line) {
  std::vector<Field> fields;
  size_t begin = 0;
  while (true) {
    const size_t comma = line.find(',', begin);
    const std::string_view raw = line.substr(begin, comma - begin);
    const size_t blank = raw.find_first_not_of(" \t");
    fields.push_back(
        {trimmed(raw), int(begin + (blank == std::string_view::npos ? 0 : blank)) + 1});
    if (comma == std::string_view::npos) return fields;
    begin = comma + 1;
  }
}

constexpr std::array<std::string_view, 6> names{"x", "y", "z", "nx", "ny", "nz"};

// Which field holds each of `names`.
std::array<size_t, 6> read_header(const std::string& path, int line_number,
                                  const std::vector<Field>& fields) {
  std::array<size_t, 6> where{};
  for (size_t n = 0; n < names.size(); ++n) {
    size_t found = fields.size();
    for (size_t f = 0; f < fields.size(); ++f)
      if (fields[f].text == names[n]) found = f;
    if (found == fields.size())
      throw InputError(path, line_number, 1,
                       fmt::format("the header x,y,z,nx,ny,nz lacks column '{}'", names[n]));
    where[n] = found;
  }
  return where;
}

}  // namespace

std::vector<MeasuringPoint> read_points(const std::string& path) {
  const std::string text = read_text_file(path, uint64_t(1) << 30);
  std::string_view rest = text;
  if (rest.starts_with("\xef\xbb\xbf")) rest.remove_prefix(3);  // byte order mark
  std::vector<MeasuringPoint> points;
  std::array<size_t, 6> where{};
  bool has_header = false;
  for (int line_number = 1; !rest.empty(); ++line_number) {
    const size_t end = rest.find('\n');
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (trimmed(line).empty()) continue;
    const std::vector<Field> fields = fields_of(line);
    if (!has_header) {
      where = read_header(path, line_number, fields);
      has_header = true;
      continue;
    }
    constexpr double largest = std::numeric_limits<float>::max();
    std::array<double, 6> v{};
    for (size_t n = 0; n < names.size(); ++n) {
      if (where[n] >= fields.size())
        throw InputError(path, line_number, int(line.size()) + 1,
                         fmt::format("column '{}' is missing", names[n]));
      const Field& f = fields[where[n]];
      const char* const last = f.text.data() + f.text.size();
      const bool has_plus = f.text.size() > 1 && f.text[0] == '+' && f.text[1] != '-';
      const auto [stop, error] = std::from_chars(f.text.data() + has_plus, last, v[n]);
      if (error != std::errc() || stop != last || !(std::abs(v[n]) <= largest))
        throw InputError(path, line_number, f.column,
                         fmt::format("'{}' is not a number", f.text.substr(0, 40)));
    }
    const MeasuringPoint p{{v[0], v[1], v[2]}, Vec3(Vec3d{v[3], v[4], v[5]})};
    constexpr double farthest = 1e9;  // metres, as for the triangles of a scene
    const Vec3d reach = abs(p.position);
    if (std::max(reach.x, std::max(reach.y, reach.z)) > farthest)
      throw InputError(path, line_number, fields[where[0]].column,
                       "the point lies more than 1e9 from the origin");
    constexpr float shortest = 1e-15f;  // the square of less loses digits
    const float l = length(p.normal);
    if (!(l >= shortest) || !std::isfinite(l))
      throw InputError(path, line_number, fields[where[3]].column, "the normal has no direction");
    points.push_back(p);
  }
  if (!has_header) throw InputError(path, 1, 1, "the header x,y,z,nx,ny,nz is missing");
  return points;
}

}  // namespace troffer
