// Chooses one light primitive for a point at random, about in proportion to what it can send there.
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

struct LightChoice {
  uint32_t primitive = 0;
  float pmf = 0;  // discrete probability; 0 = no light can reach the point
  float u = 0;    // what is left of the random number, uniform in [0,1) again
};

// Many points at once, as plain arrays of one length.
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

// A tree over light primitives that have a place, each node with the bounds, the power and a cone
// that holds the normals of its primitives [1]; built binary, then collapsed to four children per
// node, whose importances are computed at a stroke. Lights at infinity stand beside the tree: each
// that may light the point is as probable as the whole tree. Never gives probability 0 to a
// primitive that can light the point, so estimates by it are unbiased.
class LightTree {
 public:
  explicit LightTree(const LightPrimitives& primitives);
  // Over a part of them only, such as one light's.
  LightTree(const LightPrimitives& primitives, LightPrimitives::Range range);

  bool is_empty() const { return nodes_.empty() && infinite_.empty(); }

  // For a point x on a surface of unit normal n; both_sides: light from behind n counts as well.
  LightChoice choose(const Vec3& x, const Vec3& n, bool both_sides, float u) const;
  // choose() for every receiver, with the same results: out[i] for receiver i.
  void choose_many(const LightReceivers& receivers, LightChoice* out,
                   std::vector<float>& scratch) const;
  // choose() for one point and n numbers in increasing order, with the same results: out[i] for
  // u[i]. A node is weighed once for all numbers that come by it.
  void choose_sorted(const Vec3& x, const Vec3& n, bool both_sides, const float* u, size_t count,
                     LightChoice* out) const;
  // The probability with which choose() picks the primitive, which must be one of the tree's.
  float pmf(const Vec3& x, const Vec3& n, bool both_sides, uint32_t primitive) const;

  // Those within `reach` of x, by the spheres around their bounds, but those at infinity; no more
  // than `most` of them.
  void near(const Vec3& x, float reach, size_t most, std::vector<uint32_t>& out) const;

 private:
  static constexpr uint32_t width = 4;
  using Lanes = std::array<float, width>;
  // Four children side by side; unused ones have no power.
  struct alignas(16) Node {
    Lanes centre_x{}, centre_y{}, centre_z{};
    Lanes radius_squared{};              // of the sphere around the bounds
    Lanes axis_x{}, axis_y{}, axis_z{};  // of the cone that holds all normals …
    Lanes cos_spread{}, sin_spread{};    // … and its half angle
    Lanes power{};
    Lanes two_sided{};                    // 1 where any primitive emits from both sides, else 0
    std::array<uint32_t, width> child{};  // node, or primitive where is_leaf
    std::array<bool, width> is_leaf{};
    uint32_t parent = 0, slot = 0;  // slot of this node in its parent; the root has neither
  };
  struct Place {
    uint32_t node = no_node, slot = 0;
  };
  static constexpr uint32_t no_node = 0xffffffffu;

  // A light at infinity, and the directions that its light takes.
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
  uint32_t first_ = 0;         // primitive of the first place
  std::vector<Place> places_;  // of each primitive; beside the tree: no node, slot in infinite_
};

}  // namespace troffer
