#include "shadow/receiver_tree.h"

namespace troffer {

void ReceiverTree::set(const ShadowCluster& cluster, std::span<const uint32_t> members,
                       const ReceiverHull& hull) {
  cluster_ = &cluster;
  members_.assign(members.begin(), members.end());
  nodes_.clear();
  nodes_.push_back({0, uint32_t(members.size()), 0, hull});
}

uint32_t ReceiverTree::halves_of(uint32_t node) {
  if (nodes_[node].halves > 0) return nodes_[node].halves;
  const auto first = uint32_t(nodes_.size());
  nodes_[node].halves = first;
  const Node parent = nodes_[node];
  const std::span<uint32_t> all(members_.data() + parent.first, parent.count);
  const auto half = uint32_t(halve_members(*cluster_, all));
  nodes_.push_back({parent.first, half, 0, hull_of(*cluster_, all.first(half))});
  nodes_.push_back(
      {parent.first + half, parent.count - half, 0, hull_of(*cluster_, all.subspan(half))});
  return first;
}

}  // namespace troffer
