// What surfaces of the same material everywhere do with light, made once.
#pragma once

#include <optional>
#include <vector>

#include "scene/scene.h"
#include "transport/surface_scattering.h"

namespace troffer {

class EvenScatterings {
 public:
  EvenScatterings(const Scene& scene, const BsdfTables& tables);

  // Null: the material has textures, a grain, a coat of its own normal or two sides
  // (transport/two_sides.h), or comes after the first 1024: make_bsdf().
  const SurfaceScattering* find(uint32_t material, bool is_front) const {
    const size_t i = 2 * size_t(material) + (is_front ? 0 : 1);
    return i < even_.size() && even_[i] ? &*even_[i] : nullptr;
  }

 private:
  std::vector<std::optional<SurfaceScattering>> even_;  // by material and side
};

}  // namespace troffer
