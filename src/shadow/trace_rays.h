// Which of the planned rays reach their source.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shadow/plan_rays.h"
#include "shadow/shadow_scene.h"

namespace troffer {

// What all rays of a cluster to one source say of a single one.
struct RayTally {
  double rays = 0, free = 0;

  // p (1 - p) is concave: the share of all rays bounds, on average, what the shares of the single
  // groups would give.
  double spread() const {
    const double p = (free + 1) / (rays + 2);
    return p * (1 - p);
  }
};

enum class RayState : uint8_t { open, free, hidden };  // open: what it meets has a name

struct TracedRays {
  std::vector<uint8_t> is_free;   // per segment
  std::vector<RayTally> tallies;  // per source
  // memory
  std::vector<RayState> states;
  std::vector<ShadowHit> hits;
  std::vector<uint32_t> picked;  // indices of segments that go into one call
  std::vector<ShadowSegment> picked_segments;
  SegmentArrays picked_arrays;
  std::vector<ShadowHit> picked_hits;
  std::vector<float> before;
  std::vector<uint8_t> is_hidden, has_rim;
};

// Whether a ray that first met this has arrived.
bool is_free(const RaySource& source, const ShadowSegment& segment, const ShadowHit& hit,
             const ShadowScene& scene);

// Cuts the plan's segments short by what is known to be free. Facets that were met are noted with
// their sources.
void trace_rays(std::span<const RaySource> sources, RayPlan& plan, ShadowScene& scene,
                TracedRays& out);

}  // namespace troffer
