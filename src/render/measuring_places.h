// Positions of measuring points in the scene, with normals and ray offsets, as measure() uses them.
// Points on foreign surfaces are moved so that their value is unique. Lengths are in metres.
#pragma once

#include <vector>

#include "render/measure.h"
#include "transport/prepared_scene.h"

namespace troffer {

struct MeasuringPlace {
  Vec3 position;  // relative to the scene's origin
  Vec3 normal;    // unit vector
  // distance from the position along the normal at which rays start, metres
  float offset = 0;
  bool is_in_other = false;  // was exactly on another surface and has been moved
};

// Returns the places of points. A point exactly on another surface has no unique value, since its
// view ends at that surface on either side. Grid points on the floor at the foot of a wall are such
// points. They are moved within their own plane to the front of the surface, by the distance of ray
// offsets.
std::vector<MeasuringPlace> measuring_places(const PreparedScene& scene,
                                             const std::vector<MeasuringPoint>& points);

}  // namespace troffer
