// Flat convex quadrilaterals and planes as plain data. Rooms exchange occluders in this form.
// Positions are in metres.
#pragma once

#include <array>

#include "base/vec.h"

namespace troffer {

// A flat convex quadrilateral with vertices in order. A triangle repeats its last vertex.
using Quad = std::array<Vec3, 4>;

inline bool is_triangle(const Quad& q) {
  return q[2].x == q[3].x && q[2].y == q[3].y && q[2].z == q[3].z;
}

// The half-space normal · p <= distance, with a unit normal.
struct Plane {
  Vec3 normal;
  float distance = 0;
};

}  // namespace troffer
