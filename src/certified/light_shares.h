// Probabilities with which each hit of a cluster samples each light group (drawn_lights.h). They
// are proportional to the group's unoccluded light at the hit, in closed form where lights are few.
// All samples then have similar values, however close a light is to some of the hits.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "certified/light_groups.h"
#include "certified/waiting_hits.h"
#include "shadow/shadow_cluster.h"

namespace troffer {

class LightShares {
 public:
  // Sets the shares of groups[chosen[k]] at each of `members`. estimates[k] > 0: the value of
  // LightGroups::estimate() for the cluster. If there are many lights or pieces, all members get
  // the same shares, proportional to the estimates.
  void set(const LightGroups& groups, std::span<const CertifiedSource> sources,
           const WaitingHits& hits, std::span<const uint32_t> members,
           std::span<const uint32_t> chosen, std::span<const float> estimates);
  // Returns the running sums of shares, up to and including each group, for the i-th member. Sums
  // are positive.
  std::span<const float> sums(size_t i) const {
    return {sums_.data() + (is_shared_ ? 0 : i * n_), n_};
  }

 private:
  void add_source(const CertifiedSource& source, size_t k);

  size_t n_ = 0;  // number of chosen groups
  bool is_shared_ = true;
  std::vector<float> sums_;  // by member, then by group
  std::vector<ShadowReceiver> receivers_;
  ShadowCluster cluster_;
  std::vector<float> values_;
};

}  // namespace troffer
