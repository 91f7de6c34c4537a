// Binary tree of receivers with the hull of each node. Nodes are halved on demand and shared by all
// cells of a source. settle_cell.cpp descends it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shadow/shadow_cluster.h"

namespace troffer {

// Nodes are numbered; the root is 0. Not thread safe.
class ReceiverTree {
 public:
  // Resets the tree to `members`, which lie in `hull`, and keeps its memory. The cluster must
  // outlive it.
  void set(const ShadowCluster& cluster, std::span<const uint32_t> members,
           const ReceiverHull& hull);

  // Returns the members of a node. The span is valid until a node is halved.
  std::span<const uint32_t> members(uint32_t node) const {
    return {members_.data() + nodes_[node].first, nodes_[node].count};
  }
  const ReceiverHull& hull(uint32_t node) const { return nodes_[node].hull; }
  // Returns the first half of a node; the second follows it. The node must have at least two
  // members.
  uint32_t halves_of(uint32_t node);

 private:
  struct Node {
    uint32_t first, count;
    uint32_t halves;  // 0: not yet halved
    ReceiverHull hull;
  };
  const ShadowCluster* cluster_ = nullptr;
  std::vector<uint32_t> members_;
  std::vector<Node> nodes_;
};

}  // namespace troffer
