// Draws a surface's grid as SVG: false colours, values, isolux lines, and axes in metres.
// The report's page uses it. All plots of one quantity in a report share one PlotScale.
#pragma once

#include <string>
#include <vector>

#include "report/statistics.h"
#include "report/surface.h"

namespace troffer {

// Linear scale from `least` to `largest`; both 0 while it is empty.
struct PlotScale {
  double least = 0, largest = 0;
  double share(double v) const { return largest > least ? (v - least) / (largest - least) : 0.5; }
};

// Widens a scale to include values.
void widen(PlotScale& scale, const std::vector<Figure>& values);

// Returns an SVG element, at most `width` px wide. values: one per point of the grid, in `unit`
// ("lx", "%"). The view is against the surface's normal, with `along` to the right and `across`
// upward.
std::string grid_plot(const AssessedSurface& surface, const SurfaceGrid& grid,
                      const std::vector<Figure>& values, const std::string& unit,
                      const PlotScale& scale, double width);

// Returns the legend of a linear scale as an SVG element, `width` px wide.
std::string scale_legend(const PlotScale& scale, const std::string& unit, double width);

// Returns the legend of a logarithmic scale from `least` to `largest`.
std::string factor_legend(double least, double largest, const std::string& unit, double width);

}  // namespace troffer
