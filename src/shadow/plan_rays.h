// How many rays each pair that waits is worth, and where they go.
//
// A pair of receiver and cell with open light W (weighted by brightness) that casts n rays has a
// variance of at most W²/4n, as a ray's answer is 0 or 1. For a receiver with an allowed standard
// error E the numbers n_i = W_i sum W / 4E² make the sum of these bounds E² with the fewest rays.
// A weak source's visible share is kept to a looser bound of its own. These are bounds on what rays
// add to the error of the samples that they go through; that of the samples is estimated.
// References: docs/certified.md, "Residual rays".
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
  uint32_t frame, passes;  // of open samples
  bool has_values;         // those of `first_value` and the following belong to the rays
  uint32_t first_value;
  float light;                 // what all of them stand for, sr
  bool is_difference = false;  // as in RayQueue::PointPair
};

struct RayPlan {
  std::vector<RayGroup> groups;  // one for each entry of the queue, open samples first
  std::vector<ShadowSegment> segments;
  // memory
  std::vector<float> open;        // per receiver: sum of brightness × light
  std::vector<float> for_shares;  // per receiver: rays wanted for visible shares
  std::vector<Vec3> points;
};

// allowed[i]: standard error of receiver i, in brightness × sr.
void plan_rays(const RayQueue& queue, std::span<const float> allowed, const RayLimits& limits,
               RayPlan& plan);

}  // namespace troffer
