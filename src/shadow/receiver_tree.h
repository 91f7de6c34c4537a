// Receivers halved and halved again, each half with the body that holds it: made where somebody
// asks, and shared by all cells of a source.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shadow/shadow_cluster.h"

namespace troffer {

class ReceiverTree {
 public:
  // Becomes the tree of these, which `hull` holds, and keeps its memory; the cluster must stay.
  void set(const ShadowCluster& cluster, std::span<const uint32_t> members,
           const ReceiverHull& hull);

  // Nodes are numbered, the root is 0. Spans stay valid until a node is halved.
  std::span<const uint32_t> members(uint32_t node) const {
    return {members_.data() + nodes_[node].first, nodes_[node].count};
  }
  const ReceiverHull& hull(uint32_t node) const { return nodes_[node].hull; }
  // The first of a node's two halves; the other one follows it. For nodes of two members and more.
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
