// How likely each hit of a cluster draws each light: in proportion to what that sends it if nothing
// is in the way, in closed form where the lights are few. What a draw brings is then about the same
// for all of them, however near some are to some of the hits.
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
  // Of groups[chosen[k]] at each of `members`. estimates[k] > 0: what LightGroups::estimate has for
  // the cluster; where lights or their pieces are many no more than that is looked at.
  void set(const LightGroups& groups, std::span<const CertifiedSource> sources,
           const WaitingHits& hits, std::span<const uint32_t> members,
           std::span<const uint32_t> chosen, std::span<const float> estimates);
  // Sums of the shares of the groups up to and with the k-th, for the i-th member; not zero.
  std::span<const float> sums(size_t i) const {
    return {sums_.data() + (is_shared_ ? 0 : i * n_), n_};
  }

 private:
  void add_source(const CertifiedSource& source, size_t k);

  size_t n_ = 0;  // groups
  bool is_shared_ = true;
  std::vector<float> sums_;  // of one member after the other
  std::vector<ShadowReceiver> receivers_;
  ShadowCluster cluster_;
  std::vector<float> values_;
};

}  // namespace troffer
