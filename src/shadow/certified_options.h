// Settings and counts of certified visibility (certified_light.h).
#pragma once

#include <cstddef>
#include <cstdint>

#include "shadow/coverage_mask.h"
#include "shadow/cut_cells.h"

namespace troffer {

// Who asks for less than the default error may wait for it: a receiver's rays, at the most.
constexpr uint32_t most_rays_of_receiver = 4096;

struct RayLimits {
  uint32_t most_rays = 256;         // of a receiver, for its allowed error
  uint32_t most_direct_rays = 256;  // … straight to one source
  float pair_error = 0.02f;         // allowed standard error of each source's visible share …
  uint32_t most_pair_rays = 64;     // … unless that takes more rays than this,
  uint32_t most_share_rays = 512;   // or for all pairs of a receiver more than this
};

struct CertifiedOptions {
  MaskLattice lattice = coarse_lattice;
  size_t longest_list = 16384;  // facets gathered for a cluster, and no more than their masks are
                                // worth by `mask_error`
  int most_halvings = 3;   // of cluster or source, one within the other, where lists are longer
  size_t split_above = 1;  // facets in a list that make halving a cluster worth while
  size_t smallest_cluster = 16;  // receivers
  CellLimits cells;
  // Standard error allowed to the masks of a receiver, relative to the light that arrives; 0: what
  // comes of `lattice` and `cells`. Kept unless it takes more facets than rays would be cheaper.
  float mask_error = 0;
  // Standard error allowed to rays of a receiver, relative to what all sources of the cluster would
  // send unoccluded: kept unless that takes more rays than the limits allow.
  float residual_error = 0.01f;
  RayLimits rays;
  uint32_t viewing_rays = 1;     // of a pixel: they share a sequence of rays straight to sources
  uint32_t masks_with_rays = 4;  // per receiver and cell, where lists stay too long
  size_t most_found = 64;        // facets in the lists that are not complete
};

struct CertifiedCounters {
  uint64_t clusters = 0;                                 // pairs of cluster and source
  uint64_t gathers = 0, candidates = 0, incomplete = 0;  // lists, facets in them, not complete ones
  uint64_t cells = 0, masks = 0, mask_facets = 0;
  uint64_t points = 0;  // of masks and lattices, at which an integrand was looked at
};

}  // namespace troffer
