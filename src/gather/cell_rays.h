// Rays from cells, and from the places at which a picture asks: which cells they see.
#pragma once

#include <span>
#include <vector>

#include "base/process_group.h"
#include "gather/cells.h"

namespace troffer {

// Rays `first` … first + count - 1 of a sequence, dealt to some hits in turn.
struct CellTask {
  uint32_t cell = no_cell;  // whose rays they are, or none's
  uint32_t first = 0, count = 0;
  uint64_t stream = 0;
  float weight = 1;
  std::span<const CellHit> from;
  // Which half of the cell's rays these are of. Either half goes from its own half of the cell's
  // hits, so that what halves differ by tells of the choice of hits as well.
  bool is_second_half = false;
};

// What one of them sees.
struct CellSeen {
  uint32_t task = 0, cell = no_cell;
  float distance = 0;
  Rgb weight;
  CellHit hit;
};

struct CellsSeen {
  std::vector<CellSeen> seen;  // by tasks
  // Of each task: irradiance times rays, of sources that were run into, or drawn at narrow things.
  std::vector<Rgb> emission;
};

// map: may be null; else cells that it has are found, and rays look closely at narrow things if it
// does. crew: may be null. Not all of them once `stop` is set.
void trace_cell_rays(const GatherWalks& walks, const CellMap* map, std::span<const CellTask> tasks,
                     int threads, ProcessGroup* group, const StopFlag& stop, CellsSeen& out,
                     Counters& counters);

}  // namespace troffer
