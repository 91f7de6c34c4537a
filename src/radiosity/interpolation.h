// Interpolation weights of sample points at a surface position, for any quantity that points carry.
// interpolated_irradiance() and the `kj92` renderer read solutions through it.
//
// A fragment has four knots: its three corners and its centre. Weights are linear over the three
// triangles between two corners and the centre. The value at a corner is the area-weighted mean of
// the surrounding elements on the same side whose normals differ by less than 30 degrees. If the
// fragment is a whole element, the centre has the value of its sample point, because a mean of
// means would flatten steep gradients. If an element has several fragments, the value at the centre
// is the mean of the corners.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/meshing.h"

namespace troffer {

struct PointWeight {
  uint32_t point = 0;
  float weight = 0;
};

// Weights sum to 1. Empty where no light can arrive.
class Interpolation {
 public:
  std::span<const PointWeight> weights() const { return weights_; }
  void clear() { weights_.clear(); }
  void add(uint32_t point, float weight);

 private:
  std::vector<PointWeight> weights_;
};

// Sets `out` to the weights at a hit. geometry, primitive, u and v are as in Hit; `position` is the
// hit's. is_back selects the back of the surface. Reuses the memory of `out`.
void interpolate(const Scene& scene, const RadiosityMesh& mesh, uint32_t geometry,
                 uint32_t primitive, float u, float v, const Vec3& position, bool is_back,
                 Interpolation& out);

constexpr size_t knots_per_fragment = 4;
// Sets `out` to the weights at a knot of a fragment, on its front or back: a corner (0 to 2) or the
// centre (3).
void interpolate_at_knot(const RadiosityMesh& mesh, uint32_t fragment, size_t knot, bool is_back,
                         Interpolation& out);

// Returns the weights of the knots from barycentric weights of the corners.
inline std::array<float, knots_per_fragment> knot_weights(const Vec3& corners) {
  const float least = std::max(std::min({corners.x, corners.y, corners.z}), 0.0f);
  return {corners.x - least, corners.y - least, corners.z - least, 3 * least};
}

}  // namespace troffer
