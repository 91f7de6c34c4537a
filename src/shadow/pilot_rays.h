// How much of what sources would send arrives at a cluster, by a few rays, which count for nothing
// else: it decides what proofs may cost.
#pragma once

#include <span>

#include "shadow/shadow_cluster.h"
#include "shadow/shadow_scene.h"
#include "shadow/source_task.h"

namespace troffer {

// The share of the far requests' light that arrives, between 1/66 and 65/66. unoccluded: per
// request and receiver, as CertifiedMemory::all_unoccluded. Without far requests, or light of
// theirs, ½.
double far_open_share(const ShadowCluster& cluster, std::span<const LightRequest> requests,
                      std::span<const float> unoccluded, ShadowScene& scene);

// The share of the flat source's light that arrives at the receivers, between 1/130 and 129/130.
double open_share(const LightRequest& request, std::span<const ShadowReceiver> receivers,
                  ShadowScene& scene);

// So many rays to sources of which the share p arrives err by `error` of that: N of a Sobol
// sequence by about √(p (1 - p)) N^-¾.
double rays_for_error(double p, double error);

}  // namespace troffer
