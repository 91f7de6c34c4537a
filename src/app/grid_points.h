// Measuring points on a part of a scene: `troffer measure --grid`.
#pragma once

#include <string>
#include <vector>

#include "app/points_csv.h"

namespace troffer {

struct GridChoice {
  std::vector<std::string> grids;  // NODE[,HEIGHT[,SPACING]], as typed
  double border = 0;               // m off the rims, without points
};

// Adds the points of each grid: middles of cells of the node's upward faces (or of the front of one
// that is flat and has none), HEIGHT metres above them, by EN 12464-1 or at most SPACING metres
// apart. Results have a further column then, "surface". UsageError for nodes that do not exist or
// have no such face, for values that make no sense, and for more than a million points.
void add_grids(const PreparedScene& scene, const GridChoice& choice, const Vec3& up,
               PointList& list);

}  // namespace troffer
