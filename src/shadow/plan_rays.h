// Decides how many residual rays each queued pair gets, and where they go.
// A pair of receiver and cell with open light W (weighted by brightness) and n rays has a variance
// of at most W²/4n, because a ray's answer is 0 or 1. For a receiver with an allowed standard error
// E, the numbers n_i = W_i sum W / 4E² keep the sum of these bounds at E² with the fewest rays. A
// weak source's visible share has a looser bound of its own. These bounds hold for the rays alone;
// the error of the samples that they go through is estimated separately.
// References: docs/method/certified-appendix.md, "Residual rays".
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shadow/certified_options.h"
#include "shadow/ray_queue.h"

namespace troffer {

// Rays of one pair: segments [first, first + count).
struct RayGroup {
  uint32_t member, source, first, count;
  uint32_t frame, passes;  // open samples: index of their frame, number of masks
  bool has_values;         // values from `first_value` on belong to the rays
  uint32_t first_value;
  float light;                 // total light of these rays, sr
  bool is_difference = false;  // as in RayQueue::PointPair
};

struct RayPlan {
  std::vector<RayGroup> groups;  // one for each entry of the queue, open samples first
  std::vector<ShadowSegment> segments;
  // working memory
  std::vector<float> open;        // per receiver: brightness × open light
  std::vector<float> for_shares;  // per receiver: rays wanted for visible shares
  std::vector<Vec3> points;
};

// Sets `plan` to the rays of all queued pairs. allowed[i]: standard error of receiver i, in
// brightness × sr.
void plan_rays(const RayQueue& queue, std::span<const float> allowed, const RayLimits& limits,
               RayPlan& plan);

}  // namespace troffer
