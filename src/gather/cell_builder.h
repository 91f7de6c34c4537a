// Makes cache cells where pilot gather rays hit, and where rays from cells hit. Ends when cells
// without a row carry a negligible share of the light (docs/method/cells.md). Called once per
// picture or list of points (methods/methods.cpp).
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "base/process_group.h"
#include "cells/cell_rows.h"
#include "cells/cell_store.h"
#include "gather/cells.h"
#include "gather/points_noise.h"
#include "transport/direct_light.h"

namespace troffer {

// Places where light will be needed: pilot viewing rays spread over a picture, or measuring points.
struct CellPilot {
  ViewingRays viewing;
  std::vector<CellHit> places;
};

struct CellBuilderOptions {
  int threads = 0;
  uint64_t seed = 0;
  double direct_error = 0;  // asked error of direct light at cells
  double error = 0.01;      // asked error of the picture, or of the points
  // Limit of the number of cells; with more, make_cells() returns null.
  double most_cells = std::numeric_limits<double>::infinity();
  // Budget for direct light at all cells of a picture, in rays (costs.h).
  double rays_for_direct = std::numeric_limits<double>::infinity();
  ProcessGroup* group = nullptr;  // processes that make the same cells together; may be null
  // Gather rays of measuring points; most_rays is 0 if the pilot has no measuring points.
  GatheringPoints points{};
  // Once set, no further rows are made. The light of the missing rows is lost, and
  // CellStatistics::unresolved estimates its share. Null: never set.
  const StopFlag* enough = nullptr;
};

// Makes cells, or adds what the pilot needs to those of `store`, which stay as they are.
// direct: computes direct light at cells. store: cells of earlier views, or empty; holds all cells
// afterwards; may be null. progress: called with 0 to 1; may be null.
// Returns null if `stop` is set or there are too many cells; `store` must not be used then.
std::unique_ptr<Cells> make_cells(const PreparedScene& scene, const DirectLight& direct,
                                  const CellPilot& pilot, const CellBuilderOptions& options,
                                  CellStore* store, const std::function<void(double)>& progress,
                                  const StopFlag& stop, Counters& counters);

}  // namespace troffer
