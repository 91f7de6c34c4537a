// BSDF of a surface at a vertex. Takes it from UniformBsdfs if the material is the same
// everywhere, and builds it otherwise. Used by all integrators at every hit. BSDFs are in the
// vertex's shading frame.
#pragma once

#include <optional>

#include "transport/prepared_scene.h"
#include "transport/vertex.h"

namespace troffer {

inline Bsdf bsdf_at(const PreparedScene& scene, uint32_t material, const TexturePlace& uv,
                    bool is_front) {
  const SurfaceScattering* even = scene.uniform_bsdfs.find(material, is_front);
  if (even != nullptr) return even->whole;
  return make_bsdf(scene.bsdf_tables, scene.scene, material, uv, is_front);
}
inline Bsdf bsdf_at(const PreparedScene& scene, const Vertex& v) {
  return bsdf_at(scene, v.surface.material, v.surface.uv, v.is_front);
}

// The BSDF at a vertex, whole or split into its diffuse and specular part. Unlike bsdf_at() it does
// not copy BSDFs of uniform materials. It must not outlive the scene, and references that it
// returns must not outlive it.
class ScatteringAt {
 public:
  ScatteringAt(const PreparedScene& scene, const Vertex& v)
      : even_(scene.uniform_bsdfs.find(v.surface.material, v.is_front)) {
    if (even_ == nullptr)
      made_.emplace(
          make_bsdf(scene.bsdf_tables, scene.scene, v.surface.material, v.surface.uv, v.is_front));
  }
  ScatteringAt(const ScatteringAt&) = delete;
  ScatteringAt& operator=(const ScatteringAt&) = delete;

  const Bsdf& whole() const { return even_ != nullptr ? even_->whole : *made_; }
  // Returns the BSDF for take_far_side(), which modifies it. Must be called before in_parts(), and
  // only for surfaces that scatter to both sides. UniformBsdfs never holds such surfaces, so the
  // BSDF belongs to this object.
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
