// What a surface does with light where a ray meets it: made there, or kept since the scene was made
// ready (even_scatterings.h).
#pragma once

#include <optional>

#include "transport/prepared_scene.h"
#include "transport/vertex.h"

namespace troffer {

inline Bsdf bsdf_at(const PreparedScene& scene, uint32_t material, const TexturePlace& uv,
                    bool is_front) {
  const SurfaceScattering* even = scene.even_scatterings.find(material, is_front);
  if (even != nullptr) return even->whole;
  return make_bsdf(scene.bsdf_tables, scene.scene, material, uv, is_front);
}
inline Bsdf bsdf_at(const PreparedScene& scene, const Vertex& v) {
  return bsdf_at(scene, v.surface.material, v.surface.uv, v.is_front);
}

// The same without copies, whole and in parts. Stays where it was made, as long as its scene does.
class ScatteringAt {
 public:
  ScatteringAt(const PreparedScene& scene, const Vertex& v)
      : even_(scene.even_scatterings.find(v.surface.material, v.is_front)) {
    if (even_ == nullptr)
      made_.emplace(
          make_bsdf(scene.bsdf_tables, scene.scene, v.surface.material, v.surface.uv, v.is_front));
  }
  ScatteringAt(const ScatteringAt&) = delete;
  ScatteringAt& operator=(const ScatteringAt&) = delete;

  const Bsdf& whole() const { return even_ != nullptr ? even_->whole : *made_; }
  // To take a side from; before in_parts(). Surfaces of two sides are never kept.
  Bsdf& of_two_sides() { return made_.value(); }
  const SurfaceScattering& in_parts() {
    if (even_ != nullptr) return *even_;
    return parts_ ? *parts_ : parts_.emplace(*made_);
  }

 private:
  const SurfaceScattering* even_;
  std::optional<Bsdf> made_;
  std::optional<SurfaceScattering> parts_;
};

}  // namespace troffer
