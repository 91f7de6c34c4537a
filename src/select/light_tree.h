// Chooses one light primitive for a point at random, about in proportion to what it can send there.
// References: [1] Conty Estevez & Kulla, "Importance Sampling of Many Lights with Adaptive Tree
//   Splitting", HPG 2018. [2] Pharr, Jakob & Humphreys, "Physically Based Rendering", 4th ed.,
//   §12.6.3 (cones of directions around the bounds).
#pragma once

#include <cstdint>
#include <vector>

#include "base/box.h"
#include "base/vec.h"
#include "emitter/light_primitive.h"

namespace troffer {

struct LightChoice {
  uint32_t primitive = 0;
  float pmf = 0;  // discrete probability; 0 = no light can reach the point
  float u = 0;    // what is left of the random number, uniform in [0,1) again
};

// A binary tree over light primitives, each node with its bounds, its power and a cone that holds
// the normals of its primitives [1]. Never gives probability 0 to a primitive that can light the
// point, so estimates by it are unbiased.
class LightTree {
 public:
  explicit LightTree(const LightPrimitives& primitives);
  // Over a part of them only, such as one emitter's.
  LightTree(const LightPrimitives& primitives, LightPrimitives::Range range);

  bool is_empty() const { return nodes_.empty(); }

  // For a point x on a surface of unit normal n; both_sides: light from behind n counts as well.
  LightChoice choose(const Vec3& x, const Vec3& n, bool both_sides, float u) const;
  // The probability with which choose() picks the primitive, which must be one of the tree's.
  float pmf(const Vec3& x, const Vec3& n, bool both_sides, uint32_t primitive) const;

 private:
  struct Node {
    Vec3 centre, axis;
    Vec3 half_extent;
    float radius_squared = 0;  // of the sphere around the bounds
    float power = 0;
    float cos_spread = 1;  // of the cone around the axis that holds all normals
    bool is_two_sided = false;
    uint32_t second_child = 0;  // 0: a leaf; the first child is the next node
    uint32_t primitive = 0;     // leaf
  };
  struct Item;
  uint32_t build(std::vector<Item>& items, size_t first, size_t last, uint64_t trail, int depth);
  static float importance(const Node& node, const Vec3& x, const Vec3& n, bool both_sides);

  std::vector<Node> nodes_;
  uint32_t first_ = 0;            // primitive of the first trail
  std::vector<uint64_t> trails_;  // per primitive: bit d = took the second child at depth d
};

}  // namespace troffer
