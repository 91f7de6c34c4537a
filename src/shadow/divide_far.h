// A far cell (light/far_cells.h) against a cluster, divided: what one large facet hides from all of
// the cluster is dark, what few facets stand before is settled by these, and what stays too dense
// is left to whoever asked, who draws points of all that is left at a stroke.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shadow/gather_facets.h"

namespace troffer {

// Sets memory.parts. Walls hide much of a sky from a room, together with all that stands before
// them: they are tried first. `large`: facets that may hide much, at most some dozens; `most`:
// facets of a list.
void divide_far(const SourceTask& task, std::span<const uint32_t> members, const ReceiverHull& hull,
                const FlatCell& cell, ShadowScene& scene, GatherMemory& memory,
                CertifiedCounters& counters);

}  // namespace troffer
