// Lines of equal value through a grid of values.
#pragma once

#include <array>
#include <vector>

#include "base/vec.h"

namespace troffer {

// Values at the middles of a grid's cells, by rows from row 0; NaN where there is none.
struct ValueGrid {
  int columns = 0, rows = 0;
  std::vector<double> values;
  double at(int column, int row) const {
    return values[size_t(row) * size_t(columns) + size_t(column)];
  }
};

using Line = std::vector<Vec2d>;

// Lines at which the value, bilinear between the middles of cells along the sides of their squares,
// is `level`: (column, row) in cells, the middle of cell (0,0) being (0.5, 0.5). Squares with a
// missing corner have none. Closed lines end where they begin.
std::vector<Line> isolines(const ValueGrid& grid, double level);

}  // namespace troffer
