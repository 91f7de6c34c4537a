#include "annual/blinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "import/file.h"
#include "lighting/csv_table.h"

namespace troffer {

namespace {

constexpr float bright_sun_lx = 1000;  // [1]
constexpr double most_share = 0.02;    // [1]
constexpr uint64_t most_table_bytes = uint64_t(256) << 20;

// Sun of one grid in one hour.
class HourOfGrid {
 public:
  HourOfGrid(size_t paths, size_t sensors)
      : paths_(paths), sensors_(sensors), open_(paths * sensors), closed_(paths * sensors) {}

  void clear() {
    std::fill(open_.begin(), open_.end(), 0.0f);
    std::fill(closed_.begin(), closed_.end(), 0.0f);
  }
  void set(size_t path, size_t sensor, bool is_closed, float lx) {
    (is_closed ? closed_ : open_)[path * sensors_ + sensor] = lx;
  }
  // Closes groups until the grid complies, and sets is_closed per path.
  void operate(const std::vector<bool>& may_close, std::vector<bool>& is_closed) const {
    std::vector<float> sum(sensors_, 0);
    std::vector<size_t> bright(paths_, 0), order;
    for (size_t p = 0; p < paths_; ++p) {
      bool has_sun = false;
      for (size_t s = 0; s < sensors_; ++s) {
        sum[s] += open(p, s);
        bright[p] += open(p, s) >= bright_sun_lx;
        has_sun = has_sun || open(p, s) > 0;
      }
      if (may_close[p] && has_sun) order.push_back(p);
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return bright[a] > bright[b]; });
    for (const size_t p : order) {
      if (complies(sum)) return;
      is_closed[p] = true;
      for (size_t s = 0; s < sensors_; ++s) sum[s] += closed_[p * sensors_ + s] - open(p, s);
    }
  }

 private:
  float open(size_t path, size_t sensor) const { return open_[path * sensors_ + sensor]; }
  bool complies(const std::vector<float>& sum) const {
    const auto bright =
        std::count_if(sum.begin(), sum.end(), [](float lx) { return lx >= bright_sun_lx; });
    return double(bright) <= most_share * double(sensors_);
  }

  size_t paths_, sensors_;
  std::vector<float> open_, closed_;
};

// Steps through the hours of all sensors of a grid together.
class HourReader {
 public:
  HourReader(std::span<const SunOfPath> sun, const SensorSpan& grid)
      : sun_(sun), grid_(grid), at_(2 * sun.size() * grid.count, 0) {}
  // Fills in the hour; true if there is any sun. Hours must increase from call to call.
  bool read(uint32_t hour, HourOfGrid& out) {
    bool is_any = false;
    for (size_t p = 0; p < sun_.size(); ++p)
      for (const bool is_closed : {false, true})
        for (size_t s = 0; s < grid_.count; ++s) {
          const std::vector<SunHour>& hours =
              (is_closed ? sun_[p].closed : sun_[p].open)[grid_.first + s];
          size_t& at = at_[(2 * p + size_t(is_closed)) * grid_.count + s];
          if (at >= hours.size() || hours[at].hour != hour) continue;
          if (!is_any) out.clear();
          is_any = true;
          out.set(p, s, is_closed, hours[at++].lx);
        }
    return is_any;
  }

 private:
  std::span<const SunOfPath> sun_;
  SensorSpan grid_;
  std::vector<size_t> at_;
};

std::string lower_case(std::string text) {
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

StateSchedule lm83_schedule(const std::vector<LightPath>& paths, std::span<const SunOfPath> sun,
                            std::span<const SensorSpan> grids, size_t hours) {
  StateSchedule out(paths.size(), hours);
  std::vector<bool> may_close;
  for (const LightPath& p : paths) may_close.push_back(p.states.size() > 1);
  for (const SensorSpan& grid : grids) {
    HourOfGrid hour(paths.size(), grid.count);
    HourReader reader(sun, grid);
    for (size_t h = 0; h < hours; ++h) {
      if (!reader.read(uint32_t(h), hour)) continue;
      std::vector<bool> is_closed(paths.size(), false);
      hour.operate(may_close, is_closed);
      for (size_t p = 0; p < paths.size(); ++p)
        if (is_closed[p]) out.of(p)[h] = uint16_t(paths[p].states.size() - 1);
    }
  }
  return out;
}

StateSchedule read_state_schedule(const std::string& file, const std::vector<LightPath>& paths,
                                  const WeatherYear& year, const YearSkies& skies) {
  const std::string text = read_text_file(file, most_table_bytes);
  CsvReader table(file, text);
  if (table.header().line == 0)
    throw InputError(file, 1, 1, "the header with the names of window groups is missing");
  // Path of each column.
  std::vector<size_t> path_of;
  for (const std::string& name : table.header().fields) {
    const auto is_it = [&](const LightPath& p) { return lower_case(p.name) == name; };
    const auto path = std::find_if(paths.begin(), paths.end(), is_it);
    if (path == paths.end() || path->name == static_path)
      throw InputError(file, table.header().line, 1,
                       fmt::format("there is no window group '{}'", name));
    path_of.push_back(size_t(path - paths.begin()));
  }
  std::vector<std::vector<uint16_t>> steps;
  CsvRow row;
  while (table.next(row)) {
    std::vector<uint16_t>& states = steps.emplace_back(paths.size(), uint16_t(0));
    for (size_t c = 0; c < path_of.size(); ++c) {
      const auto count = double(paths[path_of[c]].states.size());
      const double v = table.number(row, c, paths[path_of[c]].name, 1e6);
      if (!(v >= 0 && v < count) || v != std::floor(v))
        table.fail(row, c, fmt::format("a state from 0 to {:.0f} is expected", count - 1));
      states[path_of[c]] = uint16_t(v);
    }
  }
  if (steps.size() != year.steps.size())
    throw InputError(file, 0, 0,
                     fmt::format("has {} rows of states, but the weather file has {} time steps",
                                 steps.size(), year.steps.size()));
  StateSchedule out(paths.size(), skies.hours());
  for (size_t p = 0; p < paths.size(); ++p)
    for (size_t h = 0; h < skies.hours(); ++h) out.of(p)[h] = steps[skies.steps[h]][p];
  return out;
}

}  // namespace troffer
