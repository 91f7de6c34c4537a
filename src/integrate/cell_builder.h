// Makes cells: where the rays hit that a picture will send, and where rays from cells hit, until
// next to nothing of the light comes from cells that know nothing of others (docs/cells.md).
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "cells/cell_rows.h"
#include "integrate/cells.h"
#include "integrate/direct_light.h"

namespace troffer {

// From where light will be asked for: some of a picture's viewing rays, all over it, or points.
struct CellPilot {
  ViewingRays viewing;
  std::vector<CellHit> places;
};

struct CellBuilderOptions {
  int threads = 0;
  uint64_t seed = 0;
};

// direct: light straight from sources. Null once `stop` is set. progress: 0 to 1; may be null.
std::unique_ptr<Cells> make_cells(const PreparedScene& scene, const DirectLight& direct,
                                  const CellPilot& pilot, const CellBuilderOptions& options,
                                  const std::function<void(double)>& progress, const StopFlag& stop,
                                  Counters& counters);

}  // namespace troffer
