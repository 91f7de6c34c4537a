// Divides a sky patch (light/sky_patches.h) for one cluster into parts. A part that one large facet
// hides from the whole cluster is dark. A part with few facets is settled by them. A part that
// stays over budget is left to the caller, who samples all such parts together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shadow/gather_facets.h"

namespace troffer {

// Cost of a ray, in facets of a mask (bench/costs; cost_of_mask_facet in transport/costs.h). Proofs
// for a source may cost about as much as the cluster's rays to all sources would, in proportion to
// the source's share of the light.
constexpr double facets_per_ray = 12;

// Sets memory.parts. Large facets (LargeFacets::large, at most some dozens) are tried first,
// because walls hide much of a sky together with everything in front of them.
void divide_sky_patch(const SourceTask& task, std::span<const uint32_t> members,
                      const ReceiverHull& hull, const FlatCell& cell, ShadowScene& scene,
                      GatherMemory& memory, CertifiedCounters& counters);

}  // namespace troffer
