// Shadow rays for what lists of facets leave open, of all sources of a cluster at a stroke: as many
// as each pair could be wrong by (plan_rays.h), traced (trace_rays.h), and added up here.
// References: docs/certified.md, "Residual rays".
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "shadow/pair_answer.h"
#include "shadow/plan_rays.h"
#include "shadow/trace_rays.h"

namespace troffer {

struct RayMemory {
  RayPlan plan;
  TracedRays traced;
  std::vector<RayAnswer> answers;
};

// One answer for each entry of the queue; valid until the next call. allowed[i]: standard error of
// receiver i, in brightness × sr. Facets that were met are noted with their sources; the
// `most_found` most hit are kept.
std::span<const RayAnswer> cast_residual_rays(const RayQueue& queue, ShadowScene& scene,
                                              std::span<const float> allowed,
                                              const RayLimits& limits, size_t most_found,
                                              RayMemory& memory);

}  // namespace troffer
