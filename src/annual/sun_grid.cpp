#include "annual/sun_grid.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/units.h"

namespace troffer {

namespace {

// Distances of the grid's positions, half of a Tregenza patch: convention. Estimated errors
// include what interpolation costs, by the shifts of replicates.
constexpr double step_of_hour_angle = rad_from_deg(6), step_of_declination = rad_from_deg(6);
// Least sine of altitude of a position. The grid reaches below the horizon, where hours near
// sunset interpolate.
constexpr double least_sine = 0.01;
constexpr double least_irradiance = 1;  // W/m²; weaker beams count as no sunshine

}  // namespace

Vec3d direction_of(const SunPosition& sun) {
  const double azimuth = rad_from_deg(sun.azimuth_deg), altitude = rad_from_deg(sun.altitude_deg);
  return {std::sin(azimuth) * std::cos(altitude), std::cos(azimuth) * std::cos(altitude),
          std::sin(altitude)};
}

bool has_sunshine(const WeatherStep& step) {
  return step.sun.altitude_deg > 0 && step.direct_normal >= least_irradiance;
}

SunGrid::SunGrid(double latitude_deg, std::span<const WeatherStep> steps, const Vec2d& shift)
    : shares_(steps.size()) {
  const double sine = std::sin(rad_from_deg(latitude_deg));
  const double cosine = std::cos(rad_from_deg(latitude_deg));
  std::map<std::pair<int, int>, uint32_t> numbers;
  const auto node_at = [&](int i, int j) {
    const auto [place, is_new] = numbers.try_emplace({i, j}, uint32_t(nodes_.size()));
    if (is_new) {
      const double declination = (i + shift.x) * step_of_declination;
      const double hour_angle = (j + shift.y) * step_of_hour_angle;
      const double toward = std::cos(declination) * std::cos(hour_angle);
      Vec3d d{-std::cos(declination) * std::sin(hour_angle),
              cosine * std::sin(declination) - sine * toward,
              sine * std::sin(declination) + cosine * toward};
      d.z = std::max(d.z, least_sine);
      nodes_.push_back(normalize(d));
    }
    return place->second;
  };
  for (size_t k = 0; k < steps.size(); ++k) {
    if (!has_sunshine(steps[k])) continue;
    const Vec3d d = direction_of(steps[k].sun);
    const double declination = std::asin(std::clamp(sine * d.z + cosine * d.y, -1.0, 1.0));
    const double hour_angle = std::atan2(-d.x, cosine * d.z - sine * d.y);
    const double x = declination / step_of_declination - shift.x;
    const double y = hour_angle / step_of_hour_angle - shift.y;
    const int i = int(std::floor(x)), j = int(std::floor(y));
    const double u = x - i, v = y - j;
    shares_[k] = {Share{node_at(i, j), float((1 - u) * (1 - v))},
                  Share{node_at(i + 1, j), float(u * (1 - v))},
                  Share{node_at(i, j + 1), float((1 - u) * v)},
                  Share{node_at(i + 1, j + 1), float(u * v)}};
  }
}

}  // namespace troffer
