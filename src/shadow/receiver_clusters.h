// Groups the hits of a tile into clusters of receivers that are certified together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"

namespace troffer {

// Clusters of receivers: those of one plane, or those of a curved surface that are close to each
// other and whose normals differ by less than about 20 degrees. order: a permutation of the
// receivers; starts: where each cluster begins in it, then its size.
struct ReceiverClusters {
  std::vector<uint32_t> order, starts;
  size_t size() const { return starts.empty() ? 0 : starts.size() - 1; }
  std::span<const uint32_t> members(size_t i) const {
    return {order.data() + starts[i], size_t(starts[i + 1] - starts[i])};
  }
};

// Sets `out` to the clusters. positions, normals (unit): of all receivers, in any order. reach:
// largest distance in a curved cluster, in metres.
void cluster_receivers(std::span<const Vec3> positions, std::span<const Vec3> normals, float reach,
                       ReceiverClusters& out);

}  // namespace troffer
