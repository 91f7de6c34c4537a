// Settings and counters of certified visibility (certified_light.h). Callers set CertifiedOptions
// from --error and from the number of viewing rays per pixel.
#pragma once

#include <cstddef>
#include <cstdint>

#include "shadow/coverage_mask.h"
#include "shadow/cut_cells.h"

namespace troffer {

// Upper limit of rays per receiver, for errors below the default.
constexpr uint32_t most_rays_of_receiver = 4096;

struct RayLimits {
  uint32_t most_rays = 256;         // per receiver, to meet its allowed error
  uint32_t most_direct_rays = 256;  // per receiver, straight to one source
  float pair_error = 0.02f;         // allowed standard error of each source's visible share,
  uint32_t most_pair_rays = 64;     // unless that takes more rays than this,
  uint32_t most_share_rays = 512;   // or more than this for all pairs of a receiver
};

struct CertifiedOptions {
  MaskLattice lattice = coarse_lattice;
  // Facets gathered for a cluster. With `mask_error`, lists are also limited to what their masks
  // are worth.
  size_t longest_list = 16384;
  int most_halvings = 3;         // nested halvings of cluster or source while lists are longer
  size_t split_above = 1;        // fewest facets in a list for which a cluster is halved
  size_t smallest_cluster = 16;  // receivers
  CellLimits cells;
  // Standard error allowed to the masks of a receiver, relative to the light that arrives. It is
  // kept unless rays would be cheaper. 0: no limit; `lattice` and `cells` alone set the error.
  float mask_error = 0;
  // Standard error allowed to the rays of a receiver, relative to the unoccluded light of all
  // sources of the cluster. It is kept unless that takes more rays than the limits allow.
  float residual_error = 0.01f;
  RayLimits rays;
  uint32_t viewing_rays = 1;     // per pixel; they share a sequence of rays straight to sources
  uint32_t masks_with_rays = 4;  // masks per receiver and cell where lists are over budget
  size_t most_found = 64;        // facets in incomplete lists
};

struct CertifiedCounters {
  uint64_t clusters = 0;                                 // pairs of cluster and source
  uint64_t gathers = 0, candidates = 0, incomplete = 0;  // lists, facets in them, incomplete ones
  uint64_t cells = 0, masks = 0, mask_facets = 0;
  uint64_t points = 0;  // mask or lattice points at which an integrand was evaluated
};

}  // namespace troffer
