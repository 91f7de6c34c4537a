// Cells and lattices with which the masks of a part keep the error that is asked for: where a mask
// is too coarse for what is open, the source is cut finer there.
//
// A few receivers of the part, the pilots, are looked at first, by masks of their own whose answers
// are then thrown away: what is found with the cells does not depend on what they were chosen by,
// and stays unbiased. How much they may err by: Promise, in source_task.h.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shadow/gather_facets.h"
#include "shadow/settle_cell.h"

namespace troffer {

struct PlannedCell {
  FlatCell cell;
  MaskLattice lattice;
  std::span<const FacetToAdd> facets;  // of the part, those that may hide some of the cell
};

struct PilotMemory {
  struct Pilot {
    uint32_t member = 0;
    // Per cell, by masks of the fine lattice, sr and sr²; and over all cells, by their lattices.
    std::vector<double> light, variance;
    double all_light = 0, all_variance = 0;
  };
  std::vector<Pilot> pilots;
  std::vector<double> costs;  // per cell: of its masks by the fine lattice, in facets
  std::vector<uint8_t> is_coarse;
  std::vector<FlatCell> cells;
  std::vector<std::vector<FacetToAdd>> facets;  // per cell that was halved from another
  std::vector<uint8_t> has_own_facets;
};

// Sets `out` to the cells of a flat part. stream: hash of the part's own.
void plan_cells(const SourceTask& task, const SourcePart& part, uint64_t stream,
                PilotMemory& memory, SettleMemory& settle, std::vector<PlannedCell>& out);

}  // namespace troffer
