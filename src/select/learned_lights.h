// Choice of lights by what arrives from them, learned from test rays: visibility included, unlike
// LightTree. Where a sky is seen through a window only, light samples then go to the window.
//
// The lights are divided into parts: all lights that have a place together, each light at
// infinity, and blocks of the numbers (u,v) from which a sky's direction is sampled. Regions of the
// scene are the leaves of trees over positions, one tree for each main direction of the normal. A
// region chooses a part with a probability in proportion to the root mean square of the light that
// test samples of the part brought there, which is best for one sample [1]. Parts with few samples
// of their own keep the estimate of the region around. A fixed share of the samples is chosen by
// LightTree as ever, so all light is found and no sample weighs more than 1/share times as much.
//
// References: [1] Vévoda, Kondapaneni & Křivánek, "Bayesian online regression for adaptive direct
//   illumination sampling", SIGGRAPH 2018. [2] Guo et al., "Primary sample space path guiding",
//   EGSR 2018 (blocks of random numbers).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "light/light.h"
#include "select/light_tree.h"

namespace troffer {

// A test sample of a light, and how much light it brought.
struct LightObservation {
  Vec3 position, normal;   // of the receiver; unit normal
  uint32_t primitive = 0;  // the light, and the numbers of the point on it
  Vec2 square;
  // Irradiance that arrived / density of the sample, given the part (all lights with a place: given
  // that one of them is chosen).
  float light = 0;
};

// Immutable; any number of threads may call it.
class LearnedLights {
 public:
  // The scene and the tree must outlive the object.
  LearnedLights(const Scene& scene, const LightPrimitives& primitives, const LightTree& tree,
                std::vector<LightObservation> observations);

  struct Choice {
    LightChoice light;  // pmf: of the light and the block, over the block's size
    Vec2 square;        // numbers for the point on the light
  };
  // Chooses a light for a point x on a surface with unit normal n. both_sides: light from behind n
  // counts too. u and square are uniform in [0,1).
  Choice choose(const Vec3& x, const Vec3& n, bool both_sides, float u, const Vec2& square) const;
  // Returns the factor on the density of sampling a light with a place, against that of the tree.
  float factor_of_placed(const Vec3& x, const Vec3& n, bool both_sides) const;
  // Returns the pmf of a light at infinity as in Choice, where it is seen in the direction wi.
  float pmf_at_infinity(const Vec3& x, const Vec3& n, bool both_sides, uint32_t primitive,
                        const Vec3& wi) const;

  size_t regions() const { return regions_; }

 private:
  // Blocks of the numbers of one light at infinity; side × side of them.
  struct Part {
    uint32_t primitive = 0, first = 0, side = 1;
  };
  struct Node {
    float split = 0;
    uint32_t axis = leaf;  // of the split; leaf: none
    uint32_t child = 0;    // first of two children; of a leaf: its region
    static constexpr uint32_t leaf = 3;
  };
  struct Teacher;

  static uint32_t class_of(const Vec3& normal);
  uint32_t block_of(const LightObservation& o) const;
  static uint32_t block_of(const Part& part, const Vec2& square);
  const Part& part_of(uint32_t primitive) const { return parts_[size_t(slots_[primitive])]; }
  const float* shares_at(const Vec3& x, const Vec3& n) const;
  float pmf_of_block(const float* shares, const Vec3& x, const Vec3& n, bool both_sides,
                     const Part& part, const Vec2& square) const;

  const Scene& scene_;
  const LightPrimitives& primitives_;
  const LightTree& tree_;
  std::vector<Part> parts_;
  std::vector<int32_t> slots_;  // of a primitive: its part; -1: it has a place
  uint32_t blocks_ = 1;         // block 0: all lights that have a place
  std::vector<Node> nodes_;
  std::array<uint32_t, 6> roots_{};
  // For each region: for each block the sum of the shares before it, and 1 at last.
  std::vector<float> shares_;
  size_t regions_ = 0;
};

}  // namespace troffer
