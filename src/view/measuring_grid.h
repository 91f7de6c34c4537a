// Makes grids of measuring points on flat rectangles. The page's grid tool uses it; lengths are in
// metres.
#pragma once

#include <vector>

#include "render/measure.h"

namespace troffer {

// Points at the middles of a rectangle's fields.
struct MeasuringGrid {
  std::vector<MeasuringPoint> points;  // row by row
  int columns = 0, rows = 0;
  double width = 0, depth = 0;  // size of the rectangle along a row and along a column, m
};

// Returns the grid of the rectangle between two opposite corners in the plane of `first`; `second`
// is projected onto it. Its sides are level, or along world axes in a level plane. Fields are
// nearly square, with `along` of them on the longer side. Throws UsageError for a rectangle without
// area, or for too many fields.
MeasuringGrid grid_between(const MeasuringPoint& first, const Vec3d& second, const Vec3& up,
                           int along);

}  // namespace troffer
