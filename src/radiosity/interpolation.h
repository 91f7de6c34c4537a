// Weights of sample points at a place, for any quantity that points carry.
//
// Within a fragment they are linear between its corners; at a corner, they are the mean over the
// elements around it on the same side whose normals differ by less than 30 degrees, by area.
#pragma once

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

// The same at corner 0 … 2 of a fragment, on its front or back.
void interpolate_at_corner(const RadiosityMesh& mesh, uint32_t fragment, size_t corner,
                           bool is_back, Interpolation& out);

}  // namespace troffer
