// Forecast of the cost of measuring a list by paths, from a look at a few points, and the choice
// between paths and cells (docs/method/measuring.md, "Short lists").
//
// Cost is counted in rays, not seconds, so that the choice is the same on every machine and for any
// number of threads.
#pragma once

#include <optional>
#include <vector>

#include "render/measured_points.h"

namespace troffer {

// Cost of making one cell, in path-traced rays; approximate (180 to 360 measured in four scenes).
constexpr double rays_of_made_cell = 200;

struct PointsForecast {
  std::vector<PointPlan> plans;  // plans of the points looked at: all points of a short list
  double samples = 0;            // mean number per point that the error asks for
  double rays = 0;               // cost by paths, for all points
  double rays_of_audit = 0;      // further cost of the audit that cells need
  // Budget for making cells, in rays, at which cells and paths cost the same. Negative if paths win
  // even against cells that cost nothing.
  double rays_for_cells = 0;

  // True if making cells is expected to exceed the budget.
  bool is_for_paths() const;
  // Returns the number of cells at which the budget is spent.
  double most_cells() const;
};

// Forecasts by a look at a few points. paths: integrator with certified direct light and
// path-traced indirect light. plan: the plan for measuring by it. Returns nothing after a stop.
std::optional<PointsForecast> forecast_points(const Integrator& paths,
                                              const std::vector<MeasuringPlace>& places,
                                              const PointPlan& plan, const PointsRun& run);

}  // namespace troffer
