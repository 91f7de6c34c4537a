// A grid of measuring points on a flat rectangle.
#pragma once

#include <vector>

#include "render/measure.h"

namespace troffer {

struct MeasuringGrid {
  std::vector<MeasuringPoint> points;  // row by row
  int columns = 0, rows = 0;
  double width = 0, depth = 0;  // m, of the rectangle: along its columns, along its rows
};

// The rectangle between two opposite corners in the plane of `first`, its sides along the plane and
// along `up` or the world's axes: the corner `second` is taken to the plane. Its fields are nearly
// square, `along` of them on its longer side; points stand in their middles. UsageError for a
// rectangle without area, or more fields than may be measured.
MeasuringGrid grid_between(const MeasuringPoint& first, const Vec3d& second, const Vec3& up,
                           int along);

}  // namespace troffer
