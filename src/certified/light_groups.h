// The lights of a scene in pieces as they are chosen for a cluster of hits: a source of certified
// visibility (both sides of it, or several that share a primitive) is one group, and so are a few
// neighbouring triangles of a light that has no certificates.
//
// What each group may send to a cluster is estimated for all of them at a stroke, a few nanoseconds
// for each: cheaper than any tree as long as there are some thousands.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "light/light_primitive.h"

namespace troffer {

// A ball that holds a cluster's receivers; `normal`: the common one, or zero; `depth`: metres by
// which, where there is one, they lie below the centre at most.
struct ClusterBall {
  Vec3 centre;
  float radius = 0;
  Vec3 normal;
  float depth = 0;
};

// What of a source counts: its primitives, and the sources of certified visibility that cover them,
// [first, last) in the caller's numbering; none where first == last.
struct LightGroup {
  uint32_t first_source = 0, last_source = 0;
  uint32_t first_primitive = 0, last_primitive = 0;  // in LightGroups::primitives
};

class LightGroups {
 public:
  // Primitives of one light, all with a surface, and which sources are made of them.
  void add(const LightPrimitives& all, std::span<const uint32_t> primitives, uint32_t first_source,
           uint32_t last_source);
  // After the last one: neighbours in space become neighbours in the order.
  void finish();

  uint32_t size() const { return uint32_t(groups_.size()); }
  bool have_all_sources() const { return with_sources_ == size(); }
  // So many have certificates that not all of them should be asked for.
  bool are_many() const { return with_sources_ >= fewest_of_many; }
  const LightGroup& operator[](uint32_t group) const { return groups_[group]; }
  // Of the group, in proportion to area by u in [0,1), which becomes uniform again; `pmf`: the
  // probability of the choice.
  uint32_t choose_primitive(uint32_t group, float& u, float& pmf) const;

  // values[g]: about what group g sends to receivers in the ball, nothing hidden, luminance × sr; 0
  // only where none of them can get any light. near[g]: the same where the group is nearer than
  // four radii of the ball, else 0.
  void estimate(const ClusterBall& ball, std::vector<float>& values,
                std::vector<float>& near) const;
  // What all of them send to a receiver at x of unit normal n, in the same unit, to a factor: it
  // takes no longer for thousands of groups, of which neighbours are taken together.
  float all_light(const Vec3& x, const Vec3& n) const;

 private:
  static constexpr uint32_t fewest_of_many = 24;
  static constexpr uint32_t most_taken_together = 64;
  struct Arrays {
    std::vector<float> x, y, z, radius;  // of a ball about the group
    std::vector<float> nx, ny, nz;       // unit mean of the normals, or zero …
    std::vector<float> spread;           // … and the sine of the angle within which they differ
    std::vector<float> two_sided;        // 1: shines both ways along its normal; else 0
    std::vector<float> strength;  // luminance × area of one side, of a sphere that of its disk
    void add(const Vec3& centre, float r, const Vec3& normal, float sine, float both_sides,
             float light);
    size_t size() const { return x.size(); }
    Vec3 centre(size_t i) const { return {x[i], y[i], z[i]}; }
    Vec3 normal(size_t i) const { return {nx[i], ny[i], nz[i]}; }
  };
  void take_together();
  static void estimate(const Arrays& groups, const ClusterBall& ball, float* values, float* near);

  Arrays arrays_;
  Arrays together_;  // of neighbours
  std::vector<LightGroup> groups_;
  uint32_t with_sources_ = 0;
  std::vector<uint32_t> primitives_;
  std::vector<float> areas_;  // per entry of primitives_: sum over the group up to and with it
};

}  // namespace troffer
