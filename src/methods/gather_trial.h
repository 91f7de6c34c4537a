// Measures what a picture by gathers costs, on a few windows of it, before the whole picture is
// gathered. The default method compares it with cached paths (certified_method.cpp).
#pragma once

#include <memory>

#include "gather/cells_indirect.h"
#include "methods/path_forecast.h"

namespace troffer {

struct GatherTrial {
  double cost = 0;        // of the whole picture, in rays (costs.h)
  double of_gathers = 0;  // the part that the gathers take
  double of_first = 0;    // the part that the first viewing rays take
};

struct GatherTrialInput {
  const Integrator& gathers;  // reads the records of `reflected`
  CellsIndirect& reflected;   // its records are replaced
  const Cells& cells;
  const PictureView& view;
  const GatherOptions& options;
  int viewing_rays = 1;        // first ones of each pixel
  double error = 0.01;         // of the picture, as for `cached`
  const PathForecast& cached;  // of paths that end at the cells
};

// Gathers in a few windows, traces their first viewing rays, and estimates from these what the
// further ones will cost. Returns a cost of 0 after a stop, and for pictures smaller than a window.
// Adds its work to `counters`.
GatherTrial try_gathers(const GatherTrialInput& in, const StopFlag& stop, Counters& counters);

}  // namespace troffer
