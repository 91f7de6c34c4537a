// Measures what a picture by gathers costs, on a few windows of it, before the whole picture is
// gathered. The default method compares ways of direct light, and cached paths, by it
// (certified_method.cpp).
#pragma once

#include <span>
#include <vector>

#include "gather/cells_indirect.h"
#include "methods/path_forecast.h"

namespace troffer {

// A way to compute a picture by gathers.
struct GatherCandidate {
  const Integrator& integrator;  // reads the records of `reflected`
  CellsIndirect& reflected;      // its records are replaced
};

// Costs in rays (costs.h), of the whole picture.
struct GatherTrial {
  struct Cost {
    double all = 0;
    double of_first = 0;  // the part that the first viewing rays take
  };
  std::vector<Cost> costs;  // of each candidate; empty after a stop and for very small pictures
  double of_gathers = 0;    // the part that the gathers take

  // Returns the number of the cheapest candidate: the first one if there are no costs.
  size_t best() const;
};

struct GatherTrialInput {
  std::span<const GatherCandidate> candidates;
  const Cells& cells;
  const PictureView& view;
  const GatherOptions& options;
  int viewing_rays = 1;        // first ones of each pixel
  double error = 0.01;         // of the picture, as for `cached`
  const PathForecast& cached;  // of paths that end at the cells
};

// Gathers in a few windows and traces their first viewing rays by each candidate. Estimates from
// these what the further viewing rays will cost. Adds its work to `counters`.
GatherTrial try_gathers(const GatherTrialInput& in, const StopFlag& stop, Counters& counters);

}  // namespace troffer
