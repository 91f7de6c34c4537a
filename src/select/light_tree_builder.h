// Builds a LightTree, which calls it in its constructor: splits by the surface area orientation
// heuristic, and cones of directions. References: as in light_tree.h.
#pragma once

#include "select/light_tree.h"

namespace troffer {

class LightTreeBuilder {
 public:
  LightTreeBuilder(const LightPrimitives& primitives, LightPrimitives::Range range,
                   LightTree& tree);
  ~LightTreeBuilder();
  LightTreeBuilder(const LightTreeBuilder&) = delete;
  LightTreeBuilder& operator=(const LightTreeBuilder&) = delete;

 private:
  struct Item;
  struct Summary;
  struct BinaryNode;

  uint32_t build_binary(size_t first, size_t last, int depth);
  size_t split(const Summary& all, size_t first, size_t last, int depth);
  uint32_t collapse(uint32_t binary);
  static void set_lane(LightTree::Node& node, uint32_t slot, const Summary& s);

  LightTree& tree_;
  std::vector<Item> items_;
  std::vector<BinaryNode> binary_;
};

}  // namespace troffer
