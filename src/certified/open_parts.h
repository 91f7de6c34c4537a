// Samples the environment light that proofs leave open, because too many facets stand before it for
// lists and masks. certified_lights.h calls this after certified_light().
//
// Points of all parts left open are sampled together, in proportion to their unoccluded light times
// its unevenness, with one shadow ray each. Which parts are left open depends on geometry and on
// rays of earlier clusters (shadow/divide_sky_patch.h), so the estimate is unbiased.
#pragma once

#include <cstdint>
#include <span>

#include "certified/drawn_lights.h"
#include "trace/occluders.h"

namespace troffer {

// Returns the scene's largest facets, which may hide much of an environment light.
LargeFacets large_facets(const Occluders& occluders);

// Inputs of sample_open_parts(). All referenced objects must outlive it.
struct OpenPartInputs {
  const PreparedScene& scene;
  const NominalSourceDensity& competition;
  const WaitingHits& hits;
  std::span<const uint32_t> members;                // hits of the cluster, in its order
  const CertifiedCluster& cluster;                  // as certified_light() left it
  std::span<const CertifiedSource* const> sources;  // sources of the cluster's requests
};

// Samples points of cluster.memory.left for each member. Their number is chosen so that they err by
// about the budget's error, relative to the light that arrives. Rays may remain pending in
// `scratch`, which draw_lights() shares; resolve_draws() finishes them.
void sample_open_parts(const OpenPartInputs& draws, const DrawingBudget& budget,
                       DrawnLightsScratch& scratch, RadianceBatch& out, Counters& counters);

}  // namespace troffer
