// Traces planned residual rays and decides which ones reach their source.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shadow/plan_rays.h"
#include "shadow/shadow_scene.h"

namespace troffer {

// Totals of a cluster's rays to one source.
struct RayTally {
  double rays = 0, free = 0;

  // Returns the variance of one ray. p (1 - p) is concave, so the share of all rays gives, on
  // average, at least the mean over single groups.
  double spread() const {
    const double p = (free + 1) / (rays + 2);
    return p * (1 - p);
  }
};

enum class RayState : uint8_t { open, free, hidden };  // open: not yet decided

struct TracedRays {
  std::vector<uint8_t> is_free;   // per segment
  std::vector<RayTally> tallies;  // per source
  // working memory
  std::vector<RayState> states;
  std::vector<ShadowHit> hits;
  std::vector<uint32_t> picked;  // indices of segments in one call
  std::vector<ShadowSegment> picked_segments;
  SegmentArrays picked_arrays;
  std::vector<ShadowHit> picked_hits;
  std::vector<float> before;
  std::vector<uint8_t> is_hidden, has_rim;
};

// True if a ray with this first hit reaches the source.
bool is_free(const RaySource& source, const ShadowSegment& segment, const ShadowHit& hit,
             const ShadowScene& scene);

// Traces the rays of the plan. Sets `first` of segments whose beginning is known to be free. Adds
// hit facets to their sources' FoundFacets.
void trace_rays(std::span<const RaySource> sources, RayPlan& plan, ShadowScene& scene,
                TracedRays& out);

}  // namespace troffer
