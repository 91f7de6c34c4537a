// Weights of sample points at a place, for any quantity that points carry.
//
// A fragment has four knots: its corners, and its middle. Weights are linear over the three
// triangles between two corners and the middle. At a corner they are the mean over the elements
// around it on the same side whose normals differ by less than 30 degrees, by area. In the middle
// of a fragment that is an element of its own they are that of its sample point, which lies there:
// a mean of means would flatten what rises steeply. Where several fragments are one element, the
// mean of the corners.
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

// Weights sum to 1. Empty where light cannot get.
class Interpolation {
 public:
  std::span<const PointWeight> weights() const { return weights_; }
  void clear() { weights_.clear(); }
  void add(uint32_t point, float weight);

 private:
  std::vector<PointWeight> weights_;
};

// geometry, primitive, u, v as in Hit; `position` is the hit's, is_back whether its back is asked
// for. Reuses the memory of `out`.
void interpolate(const Scene& scene, const RadiosityMesh& mesh, uint32_t geometry,
                 uint32_t primitive, float u, float v, const Vec3& position, bool is_back,
                 Interpolation& out);

constexpr size_t knots_per_fragment = 4;
// The same at a knot of a fragment, on its front or back: a corner, 0 … 2, or the middle, 3.
void interpolate_at_knot(const RadiosityMesh& mesh, uint32_t fragment, size_t knot, bool is_back,
                         Interpolation& out);

// Weights of the knots at weights of the corners, which sum to 1.
inline std::array<float, knots_per_fragment> knot_weights(const Vec3& corners) {
  const float least = std::max(std::min({corners.x, corners.y, corners.z}), 0.0f);
  return {corners.x - least, corners.y - least, corners.z - least, 3 * least};
}

}  // namespace troffer
