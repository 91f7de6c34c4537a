// A surface's grid as a drawing: false colours, values, isolux lines, axes in metres.
#pragma once

#include <string>
#include <vector>

#include "report/statistics.h"
#include "report/surface.h"

namespace troffer {

// An SVG element, for HTML. values: one per point of the grid, in `unit` ("lx", "%"). Seen against
// the surface's normal, `along` to the right and `across` upward.
std::string grid_plot(const AssessedSurface& surface, const SurfaceGrid& grid,
                      const std::vector<Figure>& values, const std::string& unit);

// The legend of a scale by equal factors, from `least` to `largest`, as an SVG element.
std::string factor_legend(double least, double largest, const std::string& unit);

}  // namespace troffer
