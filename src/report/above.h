// Finds what lies above points of a scene, by rays straight up.
// The search for floors and desks uses it to tell open places from covered ones. Points are in the
// file's coordinates, lengths in metres.
#pragma once

#include <vector>

#include "transport/prepared_scene.h"

namespace troffer {

// Returns a ray from `point` (in the file's coordinates) that starts clear of the surface the point
// lies on. direction: unit length.
Ray ray_from(const PreparedScene& scene, const Vec3d& point, const Vec3d& direction);

// The nearest surface above a point.
struct Above {
  double height = 0;       // distance to that surface, m; infinite if there is none
  bool is_within = false;  // true if the surface shows its back: the point lies inside a body
};

// Returns one result per point. points: in the file's coordinates; up: unit length.
std::vector<Above> above(const PreparedScene& scene, const std::vector<Vec3d>& points,
                         const Vec3d& up);

}  // namespace troffer
