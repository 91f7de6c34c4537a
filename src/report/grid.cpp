#include "report/grid.h"

#include <algorithm>
#include <cmath>

namespace troffer {

double largest_cell(double d) {
  constexpr double most = 10;
  return std::min(most, 0.2 * std::pow(5.0, std::log10(d)));
}

GridShape grid_shape(double width, double height) {
  const double longer = std::max(width, height), shorter = std::min(width, height);
  // Tolerance for rounding to float: 10 m yield ten cells, and 1.6 m is twice .8 m.
  constexpr double slack = 1e-4;
  const bool is_long = longer >= (2 - slack) * shorter;
  const double d = is_long ? shorter : longer, other = is_long ? longer : shorter;
  const double cells = std::max(1.0, std::ceil(d / largest_cell(d) - slack));
  const double others = std::max(1.0, std::ceil(other / (d / cells) - slack));
  // A limit that keeps the numbers within int; the caller reports grids with too many points.
  constexpr double most = 1e6;
  const int along = int(cells), across = int(std::min(others, most));
  const bool is_width = (width >= height) != is_long;  // d is the width
  return is_width ? GridShape{along, across} : GridShape{across, along};
}

GridShape grid_of_spacing(double width, double height, double spacing) {
  constexpr double slack = 1e-4, most = 1e6;
  const auto cells = [&](double side) {
    return int(std::clamp(std::ceil(side / spacing - slack), 1.0, most));
  };
  return {cells(width), cells(height)};
}

double border_zone(double width, double height) {
  return std::min(0.5, 0.15 * std::min(width, height));
}

}  // namespace troffer
