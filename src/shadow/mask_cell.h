// The last stage without rays: what single receivers see of a cell past the facets that are left,
// by a coverage mask for each.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shadow/lattice_integral.h"
#include "shadow/mask_points.h"
#include "shadow/source_cell_task.h"

namespace troffer {

struct MaskMemory {
  CoverageMask mask;
  OpenSamples samples;  // of the receiver looked at last
  std::vector<Vec3> points;
  std::vector<Rgb> values;
  LatticeMemory lattice;
};

// What a receiver sees of the cell, and what that may err by; share < 0: no sample stands above the
// horizon. memory.samples are the samples that are open. pass: which of several masks of the pair.
struct MaskShare {
  float share = 0, variance = 0;
};
MaskShare look_at_cell(const SourceCellTask& cell, uint32_t member, const FacetList& facets,
                       uint64_t pass, MaskMemory& memory);

// The answer for a receiver that sees all of the cell.
void add_lit(const SourceCellTask& cell, uint32_t member, MaskMemory& memory,
             SourceResults& results);

// Answers by masks, for all members; of an incomplete list by what is dark, and what is open waits
// for rays.
void mask_cell(const SourceCellTask& cell, std::span<const uint32_t> members,
               const FacetList& facets, MaskMemory& memory, SourceResults& results);

}  // namespace troffer
