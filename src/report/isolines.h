// Computes lines of equal value on a grid of values, by marching squares.
// Grid plots use it. Coordinates are in cells.
#pragma once

#include <array>
#include <vector>

#include "base/vec.h"

namespace troffer {

// Values at the middles of a grid's cells, row by row from row 0; NaN if missing.
struct ValueGrid {
  int columns = 0, rows = 0;
  std::vector<double> values;
  double at(int column, int row) const {
    return values[size_t(row) * size_t(columns) + size_t(column)];
  }
};

using Line = std::vector<Vec2d>;

// Returns the lines at which the value is `level`, linearly interpolated along the sides of the
// squares between middles of cells. Points are (column, row) in cells; the middle of cell (0,0) is
// (0.5, 0.5). Squares with a missing corner contain no lines. Closed lines end where they begin.
std::vector<Line> isolines(const ValueGrid& grid, double level);

}  // namespace troffer
