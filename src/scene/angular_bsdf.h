// Scattering of a flat layer as matrices over patches of directions, as LBNL WINDOW writes them for
// glazing, blinds and fabrics. Materials of kind `angular` hold one; bsdf/angular_lobe.h evaluates
// and samples it.
//
// Directions are unit vectors in the layer's frame: z is the normal of the surface's front, y is
// up, x = y × z. Each points away from the layer. Matrix values are in 1/sr.
//
// References: [1] Klems, "A New Method for Predicting the Solar Heat Gain of Complex Fenestration
//   Systems", ASHRAE Transactions 100(1), 1994.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/vec.h"

namespace troffer {

// Division of a hemisphere into patches: rings about the normal, each divided evenly in azimuth
// [1]. The first patch of a ring is centred on azimuth 0.
class AngleBasis {
 public:
  struct Ring {
    double theta_deg = 0;  // lower bound of the polar angle; the next ring's is the upper one
    int patches = 1;
  };

  AngleBasis() = default;
  // The last ring ends at 90°. Precondition: angles ascend from 0, and each ring has a patch.
  explicit AngleBasis(std::vector<Ring> rings);

  size_t size() const { return first_.empty() ? 0 : first_.back(); }
  size_t rings() const { return rings_.size(); }
  // Index of the patch of a direction on either side, by its x, y and |z|.
  size_t patch_of(const Vec3& w) const;
  // Returns a direction with z > 0 in a patch. u in [0,1)² is mapped uniformly to projected solid
  // angle.
  Vec3 direction(size_t patch, const Vec2& u) const;
  double projected_solid_angle(size_t patch) const;  // sr
  // Patches that touch another one, along rings and across.
  std::vector<size_t> neighbours(size_t patch) const;
  bool operator==(const AngleBasis& other) const;
  const std::vector<Ring>& all_rings() const { return rings_; }

 private:
  std::vector<Ring> rings_;
  std::vector<size_t> first_;  // index of each ring's first patch, and the number of patches
  std::vector<double> sine2_;  // squared sines of the rings' bounds
  std::vector<float> cosine_;  // cosines of the rings' bounds, falling

  size_t ring_of(size_t patch) const;
};

// Bases of LBNL WINDOW with 145, 73 and 41 patches.
AngleBasis klems_full();
AngleBasis klems_half();
AngleBasis klems_quarter();

// Matrix of one way of scattering. Light from direction i is in the patch of (-i.x, -i.y), light
// towards o in the patch of (o.x, o.y), so straight transmission and mirror reflection are on the
// diagonal.
struct AngleMatrix {
  AngleBasis in, out;
  std::vector<float> values;  // 1/sr, at [out × in.size() + in]; empty: nothing is scattered so

  bool is_empty() const { return values.empty(); }
  float at(size_t o, size_t i) const { return values[o * in.size() + i]; }
  // Share of the light of patch i that is scattered: the sum over o of value × projected solid
  // angle.
  double hemispherical(size_t i) const;
};

// Returns the matrix of light that takes the opposite ways, by reciprocity.
AngleMatrix reversed(const AngleMatrix& m);

// Largest difference between the value of a pair of patches and that of the reverse pair, over the
// larger of the matrices' greatest values. 0 for reciprocal matrices; bases must correspond.
double reciprocity_error(const AngleMatrix& m, const AngleMatrix& reverse);

struct AngularBsdf {
  std::string name;
  AngleMatrix to_front, to_back;                  // transmission from the back, from the front
  AngleMatrix front_reflection, back_reflection;  // of light that arrives at that side
};

uint64_t hash_of(const AngularBsdf& bsdf);  // of all numbers

}  // namespace troffer
