// Rays and what they hit.
#pragma once

#include <cstdint>
#include <limits>

#include "base/vec.h"

namespace troffer {

// Points origin + t direction with t_min <= t <= t_max. The direction need not be unit.
struct Ray {
  Vec3 origin;
  float t_min = 0;
  Vec3 direction;
  float t_max = std::numeric_limits<float>::infinity();
};

constexpr uint32_t no_geometry = 0xffffffffu;

// geometry: a mesh's index, or mesh count (all spheres), or mesh count + 1 (all disks);
// primitive: the triangle, sphere or disk; u, v: barycentric weights of vertices 1 and 2.
struct Hit {
  float t = 0;
  float u = 0, v = 0;
  uint32_t geometry = no_geometry;
  uint32_t primitive = 0;
  bool is_valid() const { return geometry != no_geometry; }
};

}  // namespace troffer
