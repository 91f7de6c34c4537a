// Light from infinity where facets stand too densely before it for lists and masks: points of all
// that is left of skies, images and suns are drawn together, about in proportion to what they would
// send, and a ray to each tells whether it arrives.
//
// What is left depends on geometry and on rays of earlier clusters (shadow/divide_far.h). Unbiased.
#pragma once

#include <cstdint>
#include <span>

#include "certified/drawn_lights.h"
#include "trace/occluders.h"

namespace troffer {

// What hides much of a scene from what is far away: its largest facets.
FarScene far_scene(const Occluders& occluders);

struct FarDraws {
  const PreparedScene& scene;
  const LobeCompetition& competition;
  const WaitingHits& hits;
  std::span<const uint32_t> members;                // of the cluster, in its order
  const CertifiedCluster& cluster;                  // after certified_light
  std::span<const CertifiedSource* const> sources;  // of its requests
};

// Draws points of cluster.memory.left from each member, so many that they err by the budget's error
// of the light that arrives, about. As draw_lights(), which shares the memory: resolve_draws()
// finishes it.
void draw_left(const FarDraws& draws, const DrawingBudget& budget, DrawnLightsScratch& scratch,
               RadianceBatch& out, Counters& counters);

}  // namespace troffer
