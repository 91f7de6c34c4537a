// Finds the objects above points of a scene, by rays straight up.
#pragma once

#include <vector>

#include "transport/prepared_scene.h"

namespace troffer {

// A ray from a point in the file's coordinates, clear of the surface it lies on. direction: unit.
Ray ray_from(const PreparedScene& scene, const Vec3d& point, const Vec3d& direction);

struct Above {
  double height = 0;       // of the first surface over the point, m; infinite: there is none
  bool is_within = false;  // it shows its back: the point lies within a body
};

// One per point (in the file's coordinates).
std::vector<Above> above(const PreparedScene& scene, const std::vector<Vec3d>& points,
                         const Vec3d& up);

}  // namespace troffer
