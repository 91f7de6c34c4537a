// The lights of a scene, divided into groups that are chosen for a cluster of hits
// (drawn_lights.h). A group is one source of certified visibility: both sides of it, or several
// parts that share a primitive. Lights without certificates are divided into groups of a few
// neighbouring triangles.
//
// LightGroups estimates the unoccluded light of all groups at a cluster in one vectorized pass.
// The pass takes a few nanoseconds per group. A light tree is faster only above some thousand
// groups.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "light/light_primitive.h"

namespace troffer {

// A ball that contains the receivers of a cluster. normal: their common normal, or zero if they
// differ. depth: with a normal, metres by which receivers lie below the centre at most.
struct ClusterBall {
  Vec3 centre;
  float radius = 0;
  Vec3 normal;
  float depth = 0;
};

// Index ranges of a group's primitives, and of the sources of certified visibility that cover them.
// [first_source, last_source) is in the caller's numbering, and empty if there are none.
struct LightGroup {
  uint32_t first_source = 0, last_source = 0;
  uint32_t first_primitive = 0, last_primitive = 0;  // in LightGroups::primitives
};

class LightGroups {
 public:
  // Adds a group of primitives of one light, all with a surface, and the sources made of them.
  void add(const LightPrimitives& all, std::span<const uint32_t> primitives, uint32_t first_source,
           uint32_t last_source);
  // Sorts the groups so that neighbours in space are neighbours in order. Call after the last
  // add().
  void finish();

  uint32_t size() const { return uint32_t(groups_.size()); }
  bool have_all_sources() const { return with_sources_ == size(); }
  // True if so many groups have certificates that certifying all of them does not pay.
  bool are_many() const { return with_sources_ >= fewest_of_many; }
  const LightGroup& operator[](uint32_t group) const { return groups_[group]; }
  // Chooses a primitive of the group in proportion to area by u in [0,1), and rescales u to be
  // uniform again. pmf: the probability of the choice.
  uint32_t choose_primitive(uint32_t group, float& u, float& pmf) const;

  // values[g]: approximate unoccluded light of group g at receivers in the ball, luminance × sr. It
  // is 0 only if no receiver can get any of its light. near[g]: the same if the group's centre is
  // nearer than four ball radii, else 0.
  void estimate(const ClusterBall& ball, std::vector<float>& values,
                std::vector<float>& near) const;
  // Approximate unoccluded light of all groups at a receiver x with unit normal n, luminance × sr.
  // Neighbouring groups are merged, so the cost is bounded for any number of groups.
  float all_light(const Vec3& x, const Vec3& n) const;

 private:
  // Number of certified groups from which lights count as many (docs/method/certified-appendix.md,
  // "Many lights").
  static constexpr uint32_t fewest_of_many = 24;
  // Number of merged groups that all_light() evaluates.
  static constexpr uint32_t most_taken_together = 64;
  struct Arrays {
    std::vector<float> x, y, z, radius;  // bounding ball of the group
    std::vector<float> nx, ny, nz;       // unit mean of the normals, or zero
    std::vector<float> spread;           // sine of the largest angle to the mean normal
    std::vector<float> two_sided;        // 1: emits both ways along its normal; else 0
    std::vector<float> strength;         // luminance × area of one side; of a sphere's disk
    void add(const Vec3& centre, float r, const Vec3& normal, float sine, float both_sides,
             float light);
    size_t size() const { return x.size(); }
    Vec3 centre(size_t i) const { return {x[i], y[i], z[i]}; }
    Vec3 normal(size_t i) const { return {nx[i], ny[i], nz[i]}; }
  };
  void take_together();
  static void estimate(const Arrays& groups, const ClusterBall& ball, float* values, float* near);

  Arrays arrays_;
  Arrays together_;  // merged neighbours, at most most_taken_together
  std::vector<LightGroup> groups_;
  uint32_t with_sources_ = 0;
  std::vector<uint32_t> primitives_;
  // per entry of primitives_: sum of the group's areas up to and including it
  std::vector<float> areas_;
};

}  // namespace troffer
