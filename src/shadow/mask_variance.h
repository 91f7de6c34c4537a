// Estimates the variance of a coverage mask's visible share from the mask itself. mask_cell.cpp
// uses it for estimated errors and for refinement.
#pragma once

#include "shadow/coverage_mask.h"

namespace troffer {

// Number of pairs of samples that are `steps` / n of a side of the source apart, and of those that
// differ. The n samples all lie at different places along the side.
struct OrderedPairs {
  int all = 0, differing = 0;
};
// Counts ordered pairs across the edges. edges: the side that the edges are parallel to.
OrderedPairs ordered_pairs(const CoverageMask& mask, EdgesAlong edges, uint32_t steps);

// Returns the expected variance of the mask's share. edges: the side that most edges are parallel
// to.
float mask_variance(const MaskFrame& frame, const MaskWeight& sums, const CoverageMask& mask,
                    const MaskWeights& weights, EdgesAlong edges);

}  // namespace troffer
