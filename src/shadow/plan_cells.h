// Chooses cells and lattices for the masks of a part so that they meet the asked error. Where a
// mask would be too coarse, it takes the fine lattice or halves the cell. Pilot masks of a few
// receivers decide. These masks are discarded, so the final estimate stays unbiased. Promise in
// source_task.h defines the allowed error. settle_part.cpp uses the plan.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shadow/gather_facets.h"
#include "shadow/settle_cell.h"

namespace troffer {

// A cell with the lattice of its masks.
struct PlannedCell {
  FlatCell cell;
  MaskLattice lattice;
  std::span<const FacetToAdd> facets;  // facets of the part that may hide some of the cell
};

// Working memory of plan_cells.
struct PilotMemory {
  struct Pilot {
    uint32_t member = 0;
    // Per cell, by masks of the fine lattice, in sr and sr²; and sums over all cells, each by its
    // own lattice.
    std::vector<double> light, variance;
    double all_light = 0, all_variance = 0;
  };
  std::vector<Pilot> pilots;
  std::vector<double> costs;  // per cell: cost of its masks by the fine lattice, in facets
  std::vector<uint8_t> is_coarse;
  std::vector<FlatCell> cells;
  std::vector<std::vector<FacetToAdd>> facets;  // per cell with its own list
  std::vector<uint8_t> has_own_facets;
};

// Sets `out` to the cells of a flat part. stream: a hash that is unique to the part.
void plan_cells(const SourceTask& task, const SourcePart& part, uint64_t stream,
                PilotMemory& memory, SettleMemory& settle, std::vector<PlannedCell>& out);

}  // namespace troffer
