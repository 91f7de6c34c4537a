#include "annual/stored_eyes.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "import/file.h"
#include "import/gltf/gltf_json.h"
#include "lighting/csv_table.h"

namespace troffer {

namespace {

constexpr uint64_t most_eye_bytes = uint64_t(256) << 20;  // of a file
constexpr size_t most_eyes = 1000;
constexpr double farthest_eye = 1e9;  // m
constexpr double most_lx = 1e9;

MeasuringPoint stored_eye(const JsonNode& node) {
  Vec3d p;
  size_t axis = 0;
  for (const char* name : {"x", "y", "z"}) {
    p[axis] = node.member(name).as_number();
    if (!(std::abs(p[axis++]) <= farthest_eye)) node.member(name).fail("is too far away");
  }
  const std::vector<double> d = node.member("direction").as_numbers(3);
  const Vec3d direction{d[0], d[1], d[2]};
  const double length_of = length(direction);
  if (!(length_of > 0.5) || !(length_of < 2)) node.member("direction").fail("is no unit vector");
  return {p, Vec3(direction)};
}

void read_glare_table(const std::string& path, std::span<const double> hours,
                      std::vector<StoredEye>& eyes) {
  const std::string text = read_text_file(path, most_eye_bytes);
  CsvReader table(path, text);
  std::vector<std::string> names{"hour_of_year"};
  for (size_t k = 1; k <= eyes.size(); ++k)
    for (const char* name : {"vertical_lx", "dgp"}) names.push_back(fmt::format("{}_{}", name, k));
  const std::vector<std::string_view> views(names.begin(), names.end());
  const std::string expected = "the header of glare.csv of troffer annual";
  if (table.header().line == 0) throw InputError(path, 1, 1, expected + " is missing");
  const std::vector<size_t> where = table.columns(views, views.size(), expected);
  CsvRow row;
  size_t h = 0;
  for (; table.next(row); ++h) {
    constexpr double rounding = 1e-5;  // hours are written with ten digits
    const double hour = table.number(row, where[0], names[0], 1e6);
    if (h >= hours.size() || !(std::abs(hour - hours[h]) <= rounding))
      table.fail(row, where[0], "is not the next hour of sun-up-hours.txt");
    for (size_t k = 0; k < eyes.size(); ++k) {
      const auto number = [&](size_t column) {
        return float(table.number(row, where[column], names[column], most_lx));
      };
      eyes[k].vertical_lx.push_back(number(2 * k + 1));
      eyes[k].dgp.push_back(number(2 * k + 2));
    }
  }
  if (h != hours.size())
    throw InputError(path, 0, 0,
                     fmt::format("has {} hours, and sun-up-hours.txt {}", h, hours.size()));
}

}  // namespace

std::vector<StoredEye> read_stored_eyes(const std::string& folder, std::span<const double> hours) {
  const std::string settings = folder + "/annual.json";
  const JsonDocument document{settings, read_text_file(settings, most_eye_bytes)};
  std::vector<StoredEye> eyes;
  const auto list = document.root().find_value("eyes");
  if (!list) return eyes;
  if (list->size() > most_eyes) list->fail(fmt::format("has more than {} eyes", most_eyes));
  for (size_t k = 0; k < list->size(); ++k) eyes.push_back({stored_eye(list->element(k)), {}, {}});
  if (!eyes.empty()) read_glare_table(folder + "/glare.csv", hours, eyes);
  return eyes;
}

}  // namespace troffer
