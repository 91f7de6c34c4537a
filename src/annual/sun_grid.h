// Sun positions for which reflected sunlight is computed. Reflected light varies slowly with the
// sun, so hours interpolate between positions on a grid of declination and hour angle. Each
// replicate (reflected_light.h) shifts its grid at random: the spread of replicates then includes
// the error of interpolation.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "lighting/weather_year.h"

namespace troffer {

class SunGrid {
 public:
  // Position and weight: sunlight of an hour is the weighted sum over four positions.
  struct Share {
    uint32_t node = 0;
    float weight = 0;
  };
  using Shares = std::array<Share, 4>;

  // Makes the positions that the steps with sunshine need. shift: of the grid in [0, 1)².
  SunGrid(double latitude_deg, std::span<const WeatherStep> steps, const Vec2d& shift);

  // Directions to the sun (east, north, up), unit, above the horizon.
  const std::vector<Vec3d>& nodes() const { return nodes_; }
  // Shares per step; weights are 0 for steps without sunshine.
  const std::vector<Shares>& shares() const { return shares_; }

 private:
  std::vector<Vec3d> nodes_;
  std::vector<Shares> shares_;
};

// Direction to the sun (east, north, up), unit.
Vec3d direction_of(const SunPosition& sun);

// True if sunlight counts in this step: the sun is up and shines.
bool has_sunshine(const WeatherStep& step);

}  // namespace troffer
