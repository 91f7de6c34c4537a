// Casts residual rays: shadow rays through samples that incomplete facet lists leave open, for all
// sources of a cluster together. plan_rays.h chooses their number, trace_rays.h traces them, and
// this module sums their answers. certified_light.cpp calls it.
// References: docs/method/certified-appendix.md, "Residual rays".
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "shadow/pair_answer.h"
#include "shadow/plan_rays.h"
#include "shadow/trace_rays.h"

namespace troffer {

// Working memory of cast_residual_rays.
struct RayMemory {
  RayPlan plan;
  TracedRays traced;
  std::vector<RayAnswer> answers;
};

// Returns one answer per entry of the queue, valid until the next call. allowed[i]: standard error
// of receiver i, in brightness × sr. Adds the facets that rays hit to their sources' FoundFacets,
// which keep the `most_found` most hit.
std::span<const RayAnswer> cast_residual_rays(const RayQueue& queue, ShadowScene& scene,
                                              std::span<const float> allowed,
                                              const RayLimits& limits, size_t most_found,
                                              RayMemory& memory);

}  // namespace troffer
