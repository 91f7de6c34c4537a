// Pilot rays: a few rays that estimate the share of a source's light which arrives at a cluster.
// The share decides how much proofs may cost. The rays do not enter the result.
#pragma once

#include <span>

#include "shadow/shadow_cluster.h"
#include "shadow/shadow_scene.h"
#include "shadow/source_task.h"

namespace troffer {

// Returns the share of the light from infinity that arrives, between 1/66 and 65/66. unoccluded:
// per request and receiver, as CertifiedMemory::all_unoccluded. Returns ½ if there is no such
// light.
double sky_open_share(const ShadowCluster& cluster, std::span<const LightRequest> requests,
                      std::span<const float> unoccluded, ShadowScene& scene);

// Returns the share of a flat source's light that arrives at the receivers, between 1/130 and
// 129/130.
double open_share(const LightRequest& request, std::span<const ShadowReceiver> receivers,
                  ShadowScene& scene);

// Returns the number of rays that estimate an open share p with the relative error `error`. N rays
// of a Sobol sequence err by about √(p (1 - p)) N^-¾.
double rays_for_error(double p, double error);

}  // namespace troffer
