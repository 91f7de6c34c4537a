// Traces rays of cells and of the pilot, and finds the cells that they see. Used by
// cell_builder.cpp. Results are the same for any number of threads and processes.
#pragma once

#include <span>
#include <vector>

#include "base/process_group.h"
#include "gather/cells.h"

namespace troffer {

// Rays `first` … first + count - 1 of a random sequence, which start at some hits in turn.
struct CellTask {
  uint32_t cell = no_cell;  // owner of the rays; no_cell: the pilot
  uint32_t first = 0, count = 0;
  uint64_t stream = 0;
  float weight = 1;
  std::span<const CellHit> from;
  // Half of the cell's rays that these belong to. Each half starts from its own half of the cell's
  // hits, so the difference of halves includes the choice of hits.
  bool is_second_half = false;
};

// One hit of a task's rays.
struct CellSeen {
  uint32_t task = 0, cell = no_cell;
  float distance = 0;
  Rgb weight;
  CellHit hit;
};

// A ray of a task that left the scene by way of mirrors, glass or gloss (GatherEscape).
struct CellEscape {
  uint32_t task = 0;
  Vec3 direction;
  Rgb weight;
};

struct CellsSeen {
  bool keeps_escapes = false;       // set by the caller
  std::vector<CellEscape> escapes;  // ordered by task; empty unless kept
  std::vector<CellSeen> seen;       // ordered by task
  // Per task: irradiance times rays, from sources that rays ran into, or that were sampled at
  // sub-cell features.
  std::vector<Rgb> emission;
};

// Traces all tasks. map: null, or the map in which cells are looked up; then rays resolve sub-cell
// features if the map does (CellMap::resolve_narrow). group: may be null. Incomplete once `stop` is
// set.
void trace_cell_rays(const GatherWalks& walks, const CellMap* map, std::span<const CellTask> tasks,
                     int threads, ProcessGroup* group, const StopFlag& stop, CellsSeen& out,
                     Counters& counters);

}  // namespace troffer
