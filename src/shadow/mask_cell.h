// Answers receivers of one source cell by coverage masks, one per receiver, over the facets that
// certificates leave. This is the last stage without rays. settle_cell.cpp and settle_part.cpp call
// it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shadow/lattice_integral.h"
#include "shadow/mask_points.h"
#include "shadow/source_cell_task.h"

namespace troffer {

// Working memory of the functions below.
struct MaskMemory {
  CoverageMask mask;
  OpenSamples samples;  // samples of the last receiver
  std::vector<Vec3> points;
  std::vector<Rgb> values;
  LatticeMemory lattice;
};

// Visible share of a cell and its estimated variance. share < 0: no sample lies above the horizon.
struct MaskShare {
  float share = 0, variance = 0;
};
// Computes a mask of `facets`. Sets memory.samples to the open samples. pass: which of several
// masks of the pair.
MaskShare mask_share_of(const SourceCellTask& cell, uint32_t member, const FacetList& facets,
                        uint64_t pass, MaskMemory& memory);

// Adds the answer of a receiver that sees all of the cell.
void add_lit(const SourceCellTask& cell, uint32_t member, MaskMemory& memory,
             SourceResults& results);

// Adds the answers of all members. With an incomplete list, dark samples count as dark, and rays
// are queued for open ones.
void mask_cell(const SourceCellTask& cell, std::span<const uint32_t> members,
               const FacetList& facets, MaskMemory& memory, SourceResults& results);

}  // namespace troffer
