#include "annual/stored_year.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string_view>

#include "annual/honeybee_folder.h"
#include "base/error.h"
#include "import/file.h"
#include "import/gltf/gltf_json.h"
#include "lighting/csv_table.h"

namespace troffer {

namespace {

constexpr uint64_t most_year_bytes = uint64_t(256) << 20;   // of a description
constexpr uint64_t most_metrics_bytes = uint64_t(1) << 30;  // of metrics.csv
constexpr size_t most_year_steps = size_t(366) * 24 * 60;   // a leap year by minutes
constexpr size_t most_states = 1000;                        // of a group
constexpr size_t most_sensors = 10'000'000;

JsonDocument read_year_json(const std::string& path) {
  return {path, read_text_file(path, most_year_bytes)};
}

// Reads what annual.json says beside figures.
void read_year_settings(const std::string& path, StoredYear& year) {
  const JsonDocument document = read_year_json(path);
  const JsonNode root = document.root();
  year.scene = root.member("scene").as_string();
  const JsonNode weather = root.member("weather");
  year.place = weather.string_or("place", "");
  year.zone_hours = std::clamp(weather.number_or("zone_hours", 0), -24.0, 24.0);
  const JsonNode groups = root.member("window_groups");
  for (size_t g = 0; g < groups.size(); ++g) {
    const JsonNode node = groups.element(g);
    StoredGroup& group = year.groups.emplace_back();
    group.name = node.member("name").as_string();
    const JsonNode states = node.member("states");
    if (states.size() < 1 || states.size() > most_states)
      states.fail(fmt::format("is not a list of 1 to {} states", most_states));
    for (size_t s = 0; s < states.size(); ++s)
      group.states.push_back(states.element(s).member("name").as_string());
  }
}

// Reads the middles of hours, one per line.
void read_sunny_hours(const std::string& path, StoredYear& year) {
  const std::string text = read_text_file(path, most_year_bytes);
  int line = 0;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size());
    std::string_view word(text.data() + at, end - at);
    if (word.ends_with('\r')) word.remove_suffix(1);
    ++line;
    at = end + 1;
    if (word.empty()) continue;
    double hour = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), hour);
    const double last = year.hours.empty() ? 0 : year.hours.back();
    if (error != std::errc() || stop != word.data() + word.size() || !(hour >= last) ||
        !(hour <= 366 * 24) || (!year.hours.empty() && hour == last))
      throw InputError(path, line, 1, "is not a later hour of the year");
    if (year.hours.size() == most_year_steps) throw InputError(path, line, 1, "too many hours");
    year.hours.push_back(hour);
  }
  if (year.hours.empty()) throw InputError(path, 0, 0, "lists no hour with the sun up");
}

struct StoredSteps {
  size_t all = 0;             // steps of the weather file
  std::vector<size_t> sunny;  // index of every hour among them
};

StoredSteps read_year_steps(const std::string& path, StoredYear& year) {
  const JsonDocument document = read_year_json(path);
  const JsonNode root = document.root();
  year.steps_per_hour = int(root.member("timestep").as_integer(60));
  if (year.steps_per_hour < 1) root.member("timestep").fail("is not a number from 1 to 60");
  const JsonNode all = root.member("study_hours");
  StoredSteps steps{all.size(), {}};
  double last = 0;
  for (size_t s = 0; s < all.size(); ++s) {
    last = all.element(s).as_number();
    constexpr double rounding = 1e-5;  // hours are written with ten digits
    if (steps.sunny.size() < year.hours.size() &&
        std::abs(last - year.hours[steps.sunny.size()]) <= rounding)
      steps.sunny.push_back(s);
  }
  if (steps.sunny.size() != year.hours.size())
    all.fail(fmt::format("lacks hour {:.10g} of sun-up-hours.txt", year.hours[steps.sunny.size()]));
  year.has_leap_day = last > 365 * 24;
  return steps;
}

void read_year_schedule(const std::string& path, const std::vector<std::string>& ids,
                        const StoredSteps& steps, StoredYear& year) {
  if (year.groups.empty()) return;
  const JsonDocument document = read_year_json(path);
  for (size_t g = 0; g < year.groups.size(); ++g) {
    StoredGroup& group = year.groups[g];
    const JsonNode list = document.root().member(ids[g + 1]).member("schedule");
    if (list.size() != steps.all)
      list.fail(fmt::format("has {} steps, and study_info.json {}", list.size(), steps.all));
    for (const size_t step : steps.sunny)
      group.schedule.push_back(
          uint16_t(list.element(step).as_index(group.states.size(), "states")));
  }
}

// Opens the arrays of one light path in all its states.
void add_stored_path(const std::string& arrays, const std::string& grid_id, size_t path,
                     const std::vector<std::string>& ids, StoredYear& year) {
  const size_t count = year.grids.back().count, hours = year.hours.size();
  const bool is_fixed = path == 0;
  const size_t states = is_fixed ? 1 : year.groups[path - 1].states.size();
  for (size_t s = 0; s < states; ++s) {
    const std::string folder = fmt::format(
        "{}/{}/{}/", arrays, ids[path], is_fixed ? "default" : fmt::format("{}_{}", s, ids[path]));
    const auto part = [&](const char* name) {
      return NpyArray(folder + name + "/" + grid_id + ".npy", count, hours);
    };
    year.states.push_back({year.grids.size() - 1, is_fixed ? StoredState::no_group : path - 1, s,
                           part("total"), part("direct")});
  }
}

void read_stored_grid(const JsonNode& node, const std::string& arrays,
                      const std::vector<std::string>& ids, StoredYear& year) {
  StoredGrid& grid = year.grids.emplace_back();
  grid.name = node.member("name").as_string();
  grid.first = year.grids.size() > 1 ? (&grid)[-1].first + (&grid)[-1].count : 0;
  grid.count = node.member("count").as_integer(most_sensors - grid.first);
  const std::string id = node.member("full_id").as_string();
  if (id != file_identifiers({id})[0])
    node.member("full_id").fail("is not a name of a file as troffer annual chooses them");
  const JsonNode paths = node.member("light_path");
  for (size_t p = 0; p < paths.size(); ++p) {
    const JsonNode path = paths.element(p).element(0);
    const auto at = std::find(ids.begin(), ids.end(), path.as_string());
    if (at == ids.end()) path.fail("is no window group of annual.json");
    add_stored_path(arrays, id, size_t(at - ids.begin()), ids, year);
  }
  const std::string error = arrays + "/standard_error/" + id + ".npy";
  std::error_code ignored;
  if (std::filesystem::exists(error, ignored))
    year.errors.emplace_back(NpyArray(error, grid.count, year.hours.size()));
  else
    year.errors.emplace_back();
}

// Reads the sensors of metrics.csv.
void read_stored_points(const std::string& path, StoredYear& year) {
  const std::string text = read_text_file(path, most_metrics_bytes);
  CsvReader table(path, text);
  constexpr std::array<std::string_view, 6> names{"x", "y", "z", "nx", "ny", "nz"};
  const std::string expected = "the header of metrics.csv of troffer annual";
  if (table.header().line == 0) throw InputError(path, 1, 1, expected + " is missing");
  const std::vector<size_t> where = table.columns(names, names.size(), expected);
  CsvRow row;
  while (table.next(row)) {
    constexpr double farthest = 1e9;  // m, as for points of troffer annual
    std::array<double, names.size()> v{};
    for (size_t n = 0; n < names.size(); ++n)
      v[n] = table.number(row, where[n], names[n], farthest);
    year.points.push_back({{v[0], v[1], v[2]}, Vec3(Vec3d{v[3], v[4], v[5]})});
  }
  const size_t sensors = year.grids.back().first + year.grids.back().count;
  if (year.points.size() != sensors)
    throw InputError(path, 0, 0,
                     fmt::format("lists {} sensors, and honeybee/grids_info.json {}",
                                 year.points.size(), sensors));
}

}  // namespace

StoredYear read_stored_year(const std::string& folder) {
  StoredYear year;
  year.folder = folder;
  const std::string arrays = folder + "/honeybee", settings = folder + "/annual.json";
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored))
    throw InputError(folder, -1, 0, "is no folder; give the one that troffer annual wrote (-o)");
  if (!std::filesystem::exists(settings, ignored))
    throw InputError(folder, -1, 0,
                     "holds no annual.json; give the folder that troffer annual wrote (-o)");
  read_year_settings(settings, year);
  std::vector<std::string> names{static_path};
  for (const StoredGroup& g : year.groups) names.push_back(g.name);
  const std::vector<std::string> ids = file_identifiers(names);
  read_sunny_hours(arrays + "/sun-up-hours.txt", year);
  const StoredSteps steps = read_year_steps(arrays + "/study_info.json", year);
  read_year_schedule(arrays + "/dynamic_schedule.json", ids, steps, year);
  const JsonDocument grids = read_year_json(arrays + "/grids_info.json");
  for (size_t g = 0; g < grids.root().size(); ++g)
    read_stored_grid(grids.root().element(g), arrays, ids, year);
  if (year.grids.empty()) grids.root().fail("lists no grid");
  read_stored_points(folder + "/metrics.csv", year);
  return year;
}

}  // namespace troffer
