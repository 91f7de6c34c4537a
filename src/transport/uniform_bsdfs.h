// BSDFs of materials that are the same everywhere on a surface, built once per scene. Integrators
// look them up at each hit by bsdf_at() instead of building a BSDF. Part of PreparedScene;
// immutable and thread-safe.
#pragma once

#include <optional>
#include <vector>

#include "scene/scene.h"
#include "transport/surface_scattering.h"

namespace troffer {

class UniformBsdfs {
 public:
  UniformBsdfs(const Scene& scene, const BsdfTables& tables);

  // Returns null if the material has textures, anisotropy, matrices, a coat normal map or two sides
  // (transport/two_sides.h), or is not among the first 1024. Use make_bsdf() then.
  const SurfaceScattering* find(uint32_t material, bool is_front) const {
    const size_t i = 2 * size_t(material) + (is_front ? 0 : 1);
    return i < even_.size() && even_[i] ? &*even_[i] : nullptr;
  }

 private:
  std::vector<std::optional<SurfaceScattering>> even_;  // by material and side
};

}  // namespace troffer
