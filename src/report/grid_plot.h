// A surface's grid as a drawing: false colours, values, isolux lines, axes in metres. All plots of
// one quantity in a report share one scale of colours.
#pragma once

#include <string>
#include <vector>

#include "report/statistics.h"
#include "report/surface.h"

namespace troffer {

struct PlotScale {
  double least = 0, largest = 0;
  double share(double v) const { return largest > least ? (v - least) / (largest - least) : 0.5; }
};

// Widens a scale by values; one that holds none yet becomes theirs.
void widen(PlotScale& scale, const std::vector<Figure>& values);

// An SVG element, at most `width` px wide. values: one per point of the grid, in `unit` ("lx",
// "%"). Seen against the surface's normal, `along` to the right and `across` upward.
std::string grid_plot(const AssessedSurface& surface, const SurfaceGrid& grid,
                      const std::vector<Figure>& values, const std::string& unit,
                      const PlotScale& scale, double width);

// The legend of such plots, as an SVG element `width` px wide.
std::string scale_legend(const PlotScale& scale, const std::string& unit, double width);

// The legend of a scale by equal factors, from `least` to `largest`.
std::string factor_legend(double least, double largest, const std::string& unit, double width);

}  // namespace troffer
