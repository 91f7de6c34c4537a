#include "annual/sun_disc.h"

#include <cmath>

#include "base/frame.h"
#include "base/units.h"
#include "base/warp.h"
#include "daylight/sky_model.h"

namespace troffer {

namespace {

// A point of the unit square in a stratum of the disc.
Vec2 in_stratum(size_t stratum, const Vec2& number) {
  constexpr size_t columns = 2, rows = sun_strata / columns;  // rings, sectors
  return {(float(stratum % columns) + number.x) / float(columns),
          (float(stratum / columns) + number.y) / float(rows)};
}

// Returns the direction to a point of the disc, given in units of its radius.
Vec3 at_point(const Frame& around_sun, const Vec2& point) {
  const float radius = float(std::sin(rad_from_deg(sun_angular_radius_deg)));
  const Vec2 disc = point * radius;
  return around_sun.to_world({disc.x, disc.y, std::sqrt(1 - dot(disc, disc))});
}

}  // namespace

Vec3 within_sun(const Vec3& to_sun, const Vec2& number) {
  return at_point(Frame(to_sun), disk_from_square(number));
}

std::array<Vec3, sun_strata> over_sun(const Vec3& to_sun, Random& random) {
  std::array<Vec3, sun_strata> out;
  const size_t first = random.next_u32() % sun_strata;
  for (size_t i = 0; i < sun_strata; ++i)
    out[i] = within_sun(to_sun, in_stratum((first + i) % sun_strata, random.next_vec2()));
  return out;
}

std::array<Vec3, rim_points> rim_of_sun(const Vec3& to_sun, Random& random) {
  const Frame around_sun(to_sun);
  const float first = random.next_float();
  std::array<Vec3, rim_points> out;
  for (size_t i = 0; i < rim_points; ++i) {
    const float angle = 2 * pi_f * (float(i) + first) / float(rim_points);
    out[i] = at_point(around_sun, {std::cos(angle), std::sin(angle)});
  }
  return out;
}

}  // namespace troffer
