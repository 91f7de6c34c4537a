// Hits -> clusters of receivers that can be certified together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"

namespace troffer {

// Cuts receivers (of one tile, in any order) into clusters: those of one plane together; on curved
// surfaces those whose normals differ by less than about 20 degrees and that lie close to each
// other. order: a permutation of the receivers; starts: where clusters begin in it, and its size.
struct ReceiverClusters {
  std::vector<uint32_t> order, starts;
  size_t size() const { return starts.empty() ? 0 : starts.size() - 1; }
  std::span<const uint32_t> members(size_t i) const {
    return {order.data() + starts[i], size_t(starts[i + 1] - starts[i])};
  }
};

// positions, normals (unit): of all receivers. `reach`: metres by which receivers of a curved
// cluster may lie apart.
void cluster_receivers(std::span<const Vec3> positions, std::span<const Vec3> normals, float reach,
                       ReceiverClusters& out);

}  // namespace troffer
