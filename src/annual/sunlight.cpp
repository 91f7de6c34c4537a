#include "annual/sunlight.h"

#include <algorithm>
#include <cmath>

#include "annual/open_rays.h"
#include "annual/sensor_states.h"
#include "annual/sun_grid.h"
#include "base/error.h"
#include "lighting/option_text.h"

namespace troffer {

namespace {

constexpr int minutes_of_day = 24 * 60;
constexpr int year_of_sunlight = 2015;  // any: the day's sun differs by less than a minute

// Directions to the sun, one per minute in which it counts.
std::vector<Vec3> suns_of(const WeatherYear& year, const Compass& compass, const SunlightDay& day) {
  std::vector<Vec3> suns;
  for (int minute = 0; minute < minutes_of_day; ++minute) {
    const double hour = (minute + 0.5) / 60;
    const SunPosition sun =
        sun_position(year.latitude_deg, year.longitude_deg,
                     julian_day(year_of_sunlight, day.month, day.day, hour - year.zone_hours));
    if (!(sun.altitude_deg > 0) || sun.altitude_deg < day.least_altitude_deg) continue;
    suns.emplace_back(compass.direction(sun.azimuth_deg, sun.altitude_deg));
  }
  return suns;
}

}  // namespace

SunlightDay parse_sunlight_day(const std::string& text) {
  const auto fail = [&]() -> SunlightDay {
    throw UsageError("--sunlight-day: '" + text + "' is not MM-DD or MM-DD,DEGREES, such as 03-21");
  };
  const std::vector<std::string> parts = split_text(text, ',');
  if (parts.empty() || parts.size() > 2) return fail();
  const std::vector<std::string> date = split_text(parts[0], '-');
  if (date.size() != 2) return fail();
  const auto month = parse_number(date[0]), day = parse_number(date[1]);
  constexpr std::array days{31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  if (!month || !day || *month != std::floor(*month) || *day != std::floor(*day) ||
      !(*month >= 1 && *month <= 12) || !(*day >= 1 && *day <= days[size_t(*month) - 1]))
    return fail();
  SunlightDay out{int(*month), int(*day), 0};
  if (parts.size() < 2) return out;
  const auto altitude = parse_number(parts[1]);
  if (!altitude || !(*altitude >= 0 && *altitude < 90)) return fail();
  out.least_altitude_deg = *altitude;
  return out;
}

std::vector<double> sunlight_hours(const std::vector<LightPath>& paths,
                                   const std::vector<MeasuringPoint>& points,
                                   const WeatherYear& year, const Compass& compass,
                                   const SunlightDay& day, int threads) {
  const std::vector<Vec3> suns = suns_of(year, compass, day);
  const LitStates states(paths, points);
  std::vector<double> hours(points.size(), 0);
  parallel_for(points.size(), threads, [&](size_t i) {
    std::vector<bool> is_lit(suns.size(), false);
    for (size_t p = 0; p < paths.size(); ++p) {
      const LitState& state = states[states.first_of(p)];
      OpenRays rays(state.scene->tracer);
      for (const Vec3& s : suns) {
        // A ray starts on the side of the sun.
        CellHit from = state.hits[i];
        if (dot(from.horizon, s) < 0) from.horizon = from.horizon * -1.0f;
        rays.add(from, s);
      }
      rays.trace();
      for (size_t k = 0; k < suns.size(); ++k)
        if (!rays[k].is_black()) is_lit[k] = true;
    }
    hours[i] = double(std::count(is_lit.begin(), is_lit.end(), true)) / 60;
  });
  return hours;
}

std::string sunlight_level(double hours) {
  std::string name = "none";
  for (const SunlightLevel& l : sunlight_levels)
    if (hours >= l.hours) name = l.name;
  return name;
}

}  // namespace troffer
