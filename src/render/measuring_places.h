// Where measuring points stand in the scene.
#pragma once

#include <vector>

#include "render/measure.h"
#include "transport/prepared_scene.h"

namespace troffer {

struct MeasuringPlace {
  Vec3 position;             // from the scene's origin
  Vec3 normal;               // unit
  float offset = 0;          // metres off the position, along the normal, at which rays start
  bool is_in_other = false;  // stood exactly in another surface, and has been moved
};

// A point that stands exactly in a surface that is not its own (on a floor at the foot of a wall,
// as points of grids do) has no one value: what it sees ends at that surface, on either side. It is
// moved to stand clear of the surface's front, by as much as rays start off surfaces, along its own
// plane.
std::vector<MeasuringPlace> measuring_places(const PreparedScene& scene,
                                             const std::vector<MeasuringPoint>& points);

}  // namespace troffer
