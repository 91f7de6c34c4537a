#include "annual/year_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

#include "base/error.h"
#include "import/file.h"
#include "lighting/option_text.h"

namespace troffer {

namespace {

constexpr uint64_t most_bytes = uint64_t(16) << 20;
constexpr int days_around_equinox = 15;  // [2]

// Flags of all steps of the year: occupied or not.
std::vector<uint8_t> flags_of_span(const WeatherYear& year, double from, double to) {
  std::vector<uint8_t> flags;
  for (const WeatherStep& s : year.steps)
    flags.push_back(from <= to ? s.hour >= from && s.hour < to : s.hour >= from || s.hour < to);
  return flags;
}

std::vector<uint8_t> flags_of_file(const WeatherYear& year, const std::string& path) {
  std::vector<uint8_t> flags;
  std::istringstream lines(read_text_file(path, most_bytes));
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const size_t comma = line.find_last_of(",;\t");
    std::string text = comma == std::string::npos ? line : line.substr(comma + 1);
    text.erase(
        std::remove_if(text.begin(), text.end(), [](char c) { return c == ' ' || c == '\r'; }),
        text.end());
    if (text.empty() || text[0] == '#') continue;
    const auto v = parse_number(text);
    if (!v && flags.empty()) continue;  // a header
    if (!v) throw InputError(path, number, 1, "a number expected: 0 for an unoccupied hour");
    flags.push_back(*v != 0);
  }
  if (flags.size() != year.steps.size())
    throw InputError(path, 0, 0,
                     fmt::format("has {} values, but the weather file has {} time steps",
                                 flags.size(), year.steps.size()));
  return flags;
}

std::vector<uint8_t> occupied_steps(const WeatherYear& year, const std::string& occupancy) {
  const std::vector<std::string> parts = split_text(occupancy, '-');
  if (parts.size() == 2) {
    const auto from = parse_number(parts[0]), to = parse_number(parts[1]);
    if (from && to) {
      if (!(*from >= 0 && *from <= 24 && *to >= 0 && *to <= 24) || *from == *to)
        throw UsageError("--occupancy: give two different hours from 0 to 24, such as 8-18");
      return flags_of_span(year, *from, *to);
    }
  }
  return flags_of_file(year, occupancy);
}

// Marks the brightest half of the year. The sun's altitude decides between equal hours.
void mark_daylight(const WeatherYear& year, const YearSkies& skies, YearTimes& out) {
  out.daylight = year.steps.size() / 2;
  std::vector<uint32_t> order(skies.hours());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    return skies.diffuse_lx[a] > skies.diffuse_lx[b];
  });
  out.is_daylight.assign(skies.hours(), 0);
  for (size_t i = 0; i < std::min(order.size(), out.daylight); ++i) out.is_daylight[order[i]] = 1;
}

// Returns the hour with the strongest sun around a day, among steps that contain the time.
void add_clearest(const WeatherYear& year, const YearSkies& skies, double equinox_hour, double time,
                  std::vector<uint32_t>& out) {
  const double half = 0.5 / year.steps_per_hour;
  int best = -1;
  for (size_t h = 0; h < skies.hours(); ++h) {
    const WeatherStep& s = year.steps[skies.steps[h]];
    // The hour that begins at the time: a step whose middle lies in it.
    const double after = s.hour - time;
    if (after < 0 || after > 2 * half) continue;
    if (std::abs(s.hour_of_year - equinox_hour) > 24 * (days_around_equinox + 0.5)) continue;
    if (best < 0 || s.direct_normal > year.steps[skies.steps[size_t(best)]].direct_normal)
      best = int(h);
  }
  if (best >= 0) out.push_back(uint32_t(best));
}

}  // namespace

YearTimes make_year_times(const WeatherYear& year, const YearSkies& skies,
                          const std::string& occupancy) {
  YearTimes out;
  const std::vector<uint8_t> flags = occupied_steps(year, occupancy);
  for (const uint8_t f : flags) out.occupied += f;
  if (out.occupied == 0) throw UsageError("--occupancy: no hour of the weather file is occupied");
  for (const uint32_t step : skies.steps) out.is_occupied.push_back(flags[step]);
  mark_daylight(year, skies, out);
  // Noon of 21 March and of 21 September, days 79 and 263 from 0.
  const double leap = year.has_leap_day ? 24 : 0;
  for (const double day : {79.0, 263.0}) {
    add_clearest(year, skies, day * 24 + 12 + leap, 9, out.mornings);
    add_clearest(year, skies, day * 24 + 12 + leap, 15, out.afternoons);
  }
  if (out.mornings.size() < 2 || out.afternoons.size() < 2) {
    out.mornings.clear();
    out.afternoons.clear();
  }
  return out;
}

}  // namespace troffer
