// What a coverage mask's share may err by, told from the mask itself.
#pragma once

#include "shadow/coverage_mask.h"

namespace troffer {

// Pairs of samples that are `steps` / n of one side of the source apart, n the lattice's samples,
// which all stand at different places along it; how many there are, and how many of them differ.
struct OrderedPairs {
  int all = 0, differing = 0;
};
// edges: which side they run along; pairs are those across it.
OrderedPairs ordered_pairs(const CoverageMask& mask, EdgesAlong edges, uint32_t steps);

// Expected variance of the mask's share. edges: what most edges of the facets run along.
float mask_variance(const MaskFrame& frame, const MaskWeight& sums, const CoverageMask& mask,
                    const MaskWeights& weights, EdgesAlong edges);

}  // namespace troffer
