#include "annual/stored_hours.h"

#include <algorithm>

#include "base/error.h"

namespace troffer {

namespace {

constexpr size_t block_hours = 64;             // 256 bytes of a row: five days of daylight
constexpr size_t most_kept = size_t(1) << 26;  // numbers: 256 MiB

bool is_shown(const StoredState& s, const StoredYear& year, const StoredStates& states,
              size_t hour) {
  if (s.group == StoredState::no_group) return true;
  const int chosen = states[s.group];
  return s.state == (chosen == by_schedule ? year.groups[s.group].schedule[hour] : size_t(chosen));
}

const NpyArray& array_of_part(const StoredState& s, StoredPart part) {
  return part == StoredPart::total ? s.total : s.direct;
}

// Returns the grid of a sensor.
size_t grid_of_sensor(const StoredYear& year, size_t sensor) {
  if (sensor >= year.points.size()) throw UsageError("there is no such sensor");
  const auto after =
      std::upper_bound(year.grids.begin(), year.grids.end(), sensor,
                       [](size_t s, const StoredGrid& g) { return s < g.first + g.count; });
  return size_t(after - year.grids.begin());
}

}  // namespace

void StoredHours::check(const StoredStates& states) const {
  if (states.size() != year_.groups.size())
    throw UsageError("states: one number per window group is needed");
  for (size_t g = 0; g < states.size(); ++g)
    if (states[g] != by_schedule &&
        (states[g] < 0 || size_t(states[g]) >= year_.groups[g].states.size()))
      throw UsageError("states: window group '" + year_.groups[g].name + "' has no such state");
}

std::span<const float> StoredHours::column(size_t state, StoredPart part, size_t hour) {
  const StoredState& s = year_.states[state];
  const size_t count = year_.grids[s.grid].count;
  const Block key{2 * state + (part == StoredPart::total ? 0 : 1), hour / block_hours};
  auto at = blocks_.find(key);
  if (at == blocks_.end()) {
    const size_t first = key.second * block_hours;
    const size_t hours = std::min(block_hours, year_.hours.size() - first);
    if (kept_ + count * hours > most_kept) {
      blocks_.clear();
      kept_ = 0;
    }
    at = blocks_.emplace(key, array_of_part(s, part).columns(first, hours)).first;
    kept_ += at->second.size();
  }
  return std::span(at->second).subspan(hour % block_hours * count, count);
}

std::vector<float> StoredHours::all_sensors(size_t hour, StoredPart part,
                                            const StoredStates& states) {
  check(states);
  if (hour >= year_.hours.size()) throw UsageError("there is no such hour");
  std::vector<float> sum(year_.points.size(), 0);
  for (size_t i = 0; i < year_.states.size(); ++i) {
    if (!is_shown(year_.states[i], year_, states, hour)) continue;
    float* to = sum.data() + year_.grids[year_.states[i].grid].first;
    for (const float lx : column(i, part, hour)) *to++ += lx;
  }
  return sum;
}

std::vector<float> StoredHours::all_hours(size_t sensor, StoredPart part,
                                          const StoredStates& states) const {
  check(states);
  const size_t grid = grid_of_sensor(year_, sensor);
  std::vector<float> sum(year_.hours.size(), 0);
  for (const StoredState& s : year_.states) {
    if (s.grid != grid) continue;
    const std::vector<float> row = array_of_part(s, part).row(sensor - year_.grids[grid].first);
    for (size_t h = 0; h < sum.size(); ++h)
      if (is_shown(s, year_, states, h)) sum[h] += row[h];
  }
  return sum;
}

std::vector<float> StoredHours::errors(size_t sensor) const {
  const size_t grid = grid_of_sensor(year_, sensor);
  const std::optional<NpyArray>& array = year_.errors[grid];
  return array ? array->row(sensor - year_.grids[grid].first) : std::vector<float>{};
}

}  // namespace troffer
