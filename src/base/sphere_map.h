// Maps between the unit square and all directions, for environment images. Directions are unit
// vectors in the image's own axes. Used by importers and light/.
//
//   lat_long    u: azimuth about z, from x to y, over a whole turn; v: angle from +z, over pi
//   equal_area  the octahedron unfolded so that equal areas are equal solid angles [1]: +z in the
//               centre, -z in the four corners
//
// References: [1] Clarberg, "Fast Equal-Area Mapping of the (Hemi)Sphere Using SIMD", JGT 13(3),
//   2008.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/units.h"
#include "base/vec.h"

namespace troffer {

enum class SphereMap : uint8_t { lat_long, equal_area };

inline Vec3 equal_area_direction(const Vec2& uv) {
  const float x = 2 * uv.x - 1, y = 2 * uv.y - 1;
  const float ax = std::abs(x), ay = std::abs(y);
  const float beyond = ax + ay - 1;  // above 0: the lower hemisphere, folded outwards
  // L1 distance from the nearest pole; a quarter turn runs along it.
  const float r = 1 - std::abs(beyond);
  const float across = beyond > 0 ? 1 - ax : ay;  // share of r
  const float angle = r > 0 ? across / r * (pi_f / 2) : 0;
  const float sine = r * std::sqrt(std::max(0.0f, 2 - r * r));
  const float z = 1 - r * r;
  return {std::copysign(sine * std::cos(angle), x), std::copysign(sine * std::sin(angle), y),
          beyond > 0 ? -z : z};
}

inline Vec2 equal_area_square(const Vec3& w) {
  const float ax = std::abs(w.x), ay = std::abs(w.y);
  // Avoids 1 - |z|, which cancels near the poles.
  const float sine2 = ax * ax + ay * ay;
  const float r = std::sqrt(sine2 / (1 + std::min(1.0f, std::abs(w.z))));
  const float across = r > 0 ? r * std::atan2(ay, ax) * (2 / pi_f) : 0;
  const float x = w.z < 0 ? 1 - across : r - across;
  const float y = w.z < 0 ? 1 - (r - across) : across;
  return {(std::copysign(x, w.x) + 1) / 2, (std::copysign(y, w.y) + 1) / 2};
}

inline Vec3 lat_long_direction(const Vec2& uv) {
  const float theta = pi_f * uv.y, phi = 2 * pi_f * uv.x;
  const float sine = std::sin(theta);
  return {sine * std::cos(phi), sine * std::sin(phi), std::cos(theta)};
}

inline Vec2 lat_long_square(const Vec3& w) {
  float u = std::atan2(w.y, w.x) / (2 * pi_f);
  if (u < 0) u += 1;
  // atan2 stays exact near the poles.
  return {u, std::atan2(std::sqrt(w.x * w.x + w.y * w.y), w.z) / pi_f};
}

inline Vec3 direction_from_square(SphereMap map, const Vec2& uv) {
  return map == SphereMap::lat_long ? lat_long_direction(uv) : equal_area_direction(uv);
}
inline Vec2 square_from_direction(SphereMap map, const Vec3& w) {
  return map == SphereMap::lat_long ? lat_long_square(w) : equal_area_square(w);
}

// Steradians per unit area of the square at v.
inline float solid_angle_per_area(SphereMap map, float v) {
  return map == SphereMap::lat_long ? 2 * pi_f * pi_f * std::sin(pi_f * v) : 4 * pi_f;
}

// Index of texel (x, y) of an image over the square. The texel may lie one beyond the edges, where
// the sphere continues; at the poles of lat_long the edge row repeats.
inline size_t texel_on_sphere(SphereMap map, int width, int height, int x, int y) {
  if (map == SphereMap::lat_long) {
    x = x < 0 ? width - 1 : x >= width ? 0 : x;
    y = std::clamp(y, 0, height - 1);
  } else {
    // An edge is folded about its middle.
    if (x < 0 || x >= width) {
      x = std::clamp(x, 0, width - 1);
      y = height - 1 - y;
    }
    if (y < 0 || y >= height) {
      y = std::clamp(y, 0, height - 1);
      x = width - 1 - x;
    }
  }
  return size_t(y) * size_t(width) + size_t(x);
}

}  // namespace troffer
