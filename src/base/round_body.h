// Spheres and disks as plain data. Rooms exchange occluders that are not facets in this form.
// Lengths are in metres.
#pragma once

#include "base/vec.h"

namespace troffer {

struct RoundBody {
  Vec3 centre;
  float radius = 0;
  Vec3 normal;  // unit normal of a disk; zero for a sphere

  bool is_disk() const { return normal.x != 0 || normal.y != 0 || normal.z != 0; }
};

}  // namespace troffer
