// Makes measuring points on a part of a scene, for `troffer measure --grid`. Lengths are in metres.
#pragma once

#include <string>
#include <vector>

#include "app/points_csv.h"

namespace troffer {

// Options of --grid, as typed.
struct GridChoice {
  std::vector<std::string> grids;  // NODE[,HEIGHT[,SPACING]], as typed
  double border = 0;               // width of the zone along the rims without points, m
};

// True for the endings of formats whose files may bring sensor grids along.
bool may_have_sensor_grids(const std::string& file);

// Adds all sensor grids of the scene's file. Throws UsageError if it has none.
void add_sensor_grids(const Scene& scene, PointList& list);

// Adds the points of each grid and fills PointList::surfaces. NODE alone may name
// a sensor grid of the file, or the room of such grids, whose points are taken. Other points lie at
// the middles of cells of the node's upward faces, or of the front of a flat node without upward
// faces, HEIGHT metres above them. Cells follow EN 12464-1, or are at most SPACING metres wide.
// Throws UsageError for unknown nodes, nodes without such a face, invalid values, and more than a
// million points.
void add_grids(const PreparedScene& scene, const GridChoice& choice, const Vec3& up,
               PointList& list);

}  // namespace troffer
