// Random choice of one light primitive for a point, roughly in proportion to the light that it can
// send there. Used by next-event estimation. The probability is never 0 for a primitive that can
// light the point, so estimates are unbiased.
// References: [1] Conty Estevez & Kulla, "Importance Sampling of Many Lights with Adaptive Tree
//   Splitting", HPG 2018. [2] Pharr, Jakob & Humphreys, "Physically Based Rendering", 4th ed.,
//   §12.6.3 (cones of directions around the bounds).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/box.h"
#include "base/vec.h"
#include "light/light_primitive.h"

namespace troffer {

// A chosen primitive and its probability.
struct LightChoice {
  uint32_t primitive = 0;
  float pmf = 0;  // discrete probability; 0: no light can reach the point
  float u = 0;    // remainder of the random number, again uniform in [0,1)
};

// Many points at once, as arrays of equal length.
struct LightReceivers {
  std::vector<float> x, y, z, nx, ny, nz;  // point and unit normal
  std::vector<float> sides;                // 1: light from behind the normal counts too; else 0
  std::vector<float> u;

  size_t size() const { return x.size(); }
  void resize(size_t n) {
    for (auto* a : {&x, &y, &z, &nx, &ny, &nz, &sides, &u}) a->resize(n);
  }
  Vec3 position(size_t i) const { return {x[i], y[i], z[i]}; }
  Vec3 normal(size_t i) const { return {nx[i], ny[i], nz[i]}; }
  void set(size_t i, const Vec3& p, const Vec3& n, bool both_sides, float random) {
    x[i] = p.x;
    y[i] = p.y;
    z[i] = p.z;
    nx[i] = n.x;
    ny[i] = n.y;
    nz[i] = n.z;
    sides[i] = both_sides ? 1.0f : 0.0f;
    u[i] = random;
  }
};

// A tree over all light primitives that have a place. Each node has the bounds, the power and a
// cone of the normals of its primitives [1]. It is built as a binary tree, then collapsed to four
// children per node, whose importances are computed together.
//
// Lights at infinity stand outside the tree: each one that may light the point is as probable as
// the whole tree. Immutable; any number of threads may call it.
class LightTree {
 public:
  explicit LightTree(const LightPrimitives& primitives);
  // Over a range of primitives only, such as those of one light.
  LightTree(const LightPrimitives& primitives, LightPrimitives::Range range);

  bool is_empty() const { return nodes_.empty() && infinite_.empty(); }

  // Chooses a primitive for a point x on a surface with unit normal n. both_sides: light from
  // behind n counts too. u: uniform in [0,1).
  LightChoice choose(const Vec3& x, const Vec3& n, bool both_sides, float u) const;
  // Calls choose() for every receiver, with the same results: out[i] for receiver i.
  void choose_many(const LightReceivers& receivers, LightChoice* out,
                   std::vector<float>& scratch) const;
  // Calls choose() for one point and `count` numbers u in increasing order, with the same results.
  // Evaluates each node only once.
  void choose_sorted(const Vec3& x, const Vec3& n, bool both_sides, const float* u, size_t count,
                     LightChoice* out) const;
  // Probability with which choose() picks `primitive`, which must be one of the tree's.
  float pmf(const Vec3& x, const Vec3& n, bool both_sides, uint32_t primitive) const;

  // Probability with which choose() picks a light that has a place, not one at infinity.
  float chance_of_placed(const Vec3& x, const Vec3& n, bool both_sides) const;
  // Chooses a light that has a place. The result has the pmf of choose(); 0: none can reach x.
  LightChoice choose_placed(const Vec3& x, const Vec3& n, bool both_sides, float u) const;

  // Lists primitives whose bounding sphere is within `reach` metres of x, at most `most` of them;
  // never lights at infinity.
  void near(const Vec3& x, float reach, size_t most, std::vector<uint32_t>& out) const;

 private:
  static constexpr uint32_t width = 4;
  using Lanes = std::array<float, width>;
  // Four children side by side; unused ones have zero power.
  struct alignas(16) Node {
    Lanes centre_x{}, centre_y{}, centre_z{};
    Lanes radius_squared{};              // squared radius of the sphere around the bounds
    Lanes axis_x{}, axis_y{}, axis_z{};  // axis of the cone that contains all normals
    Lanes cos_spread{}, sin_spread{};    // half angle of that cone
    Lanes power{};
    Lanes two_sided{};                    // 1: some primitive emits from both sides; else 0
    std::array<uint32_t, width> child{};  // index of a node, or of a primitive if is_leaf
    std::array<bool, width> is_leaf{};
    uint32_t parent = 0, slot = 0;  // position of this node in its parent; unused at the root
    // Position of a primitive: a lane of a node.
  };
  struct Place {
    uint32_t node = no_node, slot = 0;
  };
  static constexpr uint32_t no_node = 0xffffffffu;

  // A light at infinity, and the cone of directions in which its light travels.
  struct Infinite {
    uint32_t primitive = 0;
    Vec3 axis;
    float sin_spread = 0;
    bool is_everywhere = false;
    bool may_light(const Vec3& n, bool both_sides) const {
      return is_everywhere || both_sides || dot(axis, n) < sin_spread;
    }
  };

  friend class LightTreeBuilder;
  float weight_sum(const Vec3& x, const Vec3& n, bool both_sides) const;
  bool choose_infinite(const Vec3& x, const Vec3& n, bool both_sides, LightChoice& choice) const;
  static void importances(const Node& node, const Vec3& x, const Vec3& n, bool both_sides,
                          Lanes& out);
  static uint32_t pick(const Lanes& weight, float& pmf, float& u);
  void near_below(uint32_t at, const Vec3& x, float reach, size_t most,
                  std::vector<uint32_t>& out) const;
  void choose_sorted_below(uint32_t at, const Vec3& x, const Vec3& n, bool both_sides, size_t count,
                           LightChoice* out) const;
  LightChoice choose_below(uint32_t at, const Vec3& x, const Vec3& n, bool both_sides, float pmf,
                           float u) const;

  std::vector<Node> nodes_;
  std::vector<Infinite> infinite_;
  uint32_t first_ = 0;         // index of the first primitive
  std::vector<Place> places_;  // by primitive; at infinity: no_node, and slot in infinite_
};

}  // namespace troffer
