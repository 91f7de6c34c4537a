// The grid of sun positions: interpolation of functions of the sun's direction.
#include "annual/sun_grid.h"

#include <doctest/doctest.h>

#include <cmath>

#include "base/units.h"

using namespace troffer;

namespace {

std::vector<WeatherStep> sunny_steps(double latitude) {
  std::vector<WeatherStep> steps;
  for (int month = 1; month <= 12; ++month)
    for (double hour = 0.5; hour < 24; ++hour) {
      WeatherStep& s = steps.emplace_back();
      s.month = month;
      s.direct_normal = 500;
      s.sun = sun_position(latitude, 0, julian_day(2015, month, 21, hour));
    }
  return steps;
}

}  // namespace

// A bilinear interpolation errs by at most h²/8 of the second derivative in each direction. Sines
// of the sun's coordinates have second derivatives of at most 1 in hour angle and declination:
// (6°)²/8 + (6°)²/8 = 0.0027.
TEST_CASE("interpolated directions of the sun are close to the true ones") {
  for (const double latitude : {-35.0, 0.0, 48.0, 70.0}) {
    CAPTURE(latitude);
    const std::vector<WeatherStep> steps = sunny_steps(latitude);
    const SunGrid grid(latitude, steps, {0.3, 0.8});
    size_t compared = 0;
    for (size_t i = 0; i < steps.size(); ++i) {
      double weights = 0;
      Vec3d sum{};
      for (const SunGrid::Share& s : grid.shares()[i]) {
        weights += double(s.weight);
        if (s.weight != 0) sum += grid.nodes()[s.node] * double(s.weight);
      }
      if (steps[i].sun.altitude_deg <= 0) {
        CHECK(weights == 0);
        continue;
      }
      CHECK(weights == doctest::Approx(1).epsilon(1e-5));
      if (steps[i].sun.altitude_deg < 10) continue;  // positions near the horizon are raised
      const Vec3d error = sum - direction_of(steps[i].sun);
      // Hour angles are wide apart in direction only as the cosine of declination: bound as above.
      for (size_t k = 0; k < 3; ++k) CHECK(std::abs(error[k]) < 0.0032);
      ++compared;
    }
    CHECK(compared > 50);
  }
}

TEST_CASE("positions are above the horizon and few") {
  const std::vector<WeatherStep> steps = sunny_steps(48);
  const SunGrid grid(48, steps, {0, 0});
  CHECK(grid.nodes().size() < 400);
  for (const Vec3d& d : grid.nodes()) {
    CHECK(length(d) == doctest::Approx(1));
    CHECK(d.z > 0);
  }
}
