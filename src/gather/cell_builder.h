// Makes cells: where the rays hit that a picture will send, and where rays from cells hit, until
// next to nothing of the light comes from cells that know nothing of others (docs/cells.md).
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

// From where light will be asked for: some of a picture's viewing rays, all over it, or points.
struct CellPilot {
  ViewingRays viewing;
  std::vector<CellHit> places;
};

struct CellBuilderOptions {
  int threads = 0;
  uint64_t seed = 0;
  double direct_error = 0;  // asked of the light straight from sources
  double error = 0.01;      // asked of the picture
  // None are made where there would be more than this.
  double most_cells = std::numeric_limits<double>::infinity();
  ProcessGroup* group = nullptr;  // others that make the same cells; may be null
  GatheringPoints points{};  // how those of the pilot gather; most_rays 0: nothing is done for that
  // Once set, no further rows are made: light that only they would bring is missing, and
  // CellStatistics::unresolved estimates its share. Null: never.
  const StopFlag* enough = nullptr;
};

// direct: light straight from sources. store: what is kept from before, or nothing yet; left with
// what there is now (empty once stopped), and may be null. Cells that have been kept serve as they
// are; only what the pilot asks for beyond them is made. Null once `stop` is set, or
// where there would be too many. progress: 0 to 1;
// may be null.
std::unique_ptr<Cells> make_cells(const PreparedScene& scene, const DirectLight& direct,
                                  const CellPilot& pilot, const CellBuilderOptions& options,
                                  CellStore* store, const std::function<void(double)>& progress,
                                  const StopFlag& stop, Counters& counters);

}  // namespace troffer
