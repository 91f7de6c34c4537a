// What a list of points would take by paths, from a look at a few of them; and whether that is less
// than cells and their audit would take (docs/measure.md, "Short lists").
//
// Work is counted in rays, never in seconds: the same choice on every machine and for any number of
// threads.
#pragma once

#include <optional>
#include <vector>

#include "render/measured_points.h"

namespace troffer {

// That a cell's making takes as long as, about.
constexpr double rays_of_made_cell = 200;

struct PointsForecast {
  std::vector<PointPlan> plans;  // of the points that were looked at: all of a short list
  double samples = 0;            // of a point, on average, as many as the error wants
  double rays = 0;               // of all kinds, for all points
  double rays_of_audit = 0;      // that points by cells take besides
  // What else the list would take that much for: cells' making, in rays. Negative: paths take less
  // than points by cells do even if cells cost nothing.
  double rays_for_cells = 0;

  // Whether cells would take more than that, as far as can be told beforehand.
  bool is_for_paths() const;
  // If not: more of them than these would.
  double most_cells() const;
};

// paths: certified light straight from sources, the rest by paths. plan: how points would be
// measured by them. Empty where a stop came before.
std::optional<PointsForecast> forecast_points(const Integrator& paths,
                                              const std::vector<MeasuringPlace>& places,
                                              const PointPlan& plan, const PointsRun& run);

}  // namespace troffer
