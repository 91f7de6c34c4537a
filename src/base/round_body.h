// Spheres and disks as plain data: what rooms hand each other when they speak of occluders that are
// no facets.
#pragma once

#include "base/vec.h"

namespace troffer {

struct RoundBody {
  Vec3 centre;
  float radius = 0;
  Vec3 normal;  // of a disk, unit; of a sphere zero

  bool is_disk() const { return normal.x != 0 || normal.y != 0 || normal.z != 0; }
};

}  // namespace troffer
