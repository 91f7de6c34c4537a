// Nominal density of source sampling, per sr, for multiple importance sampling against the rays
// that rough lobes spawn. It only approximates the actual sampling. MIS needs no more than that
// both techniques use the same density.
#pragma once

#include <cstdint>

#include "base/vec.h"

namespace troffer {

class LightGroups;
class PreparedScene;
struct CertifiedSource;

// A surface point x with unit geometric normal n.
struct SurfacePlace {
  Vec3 x, n;
  float all_light = 0;  // unoccluded light of all lights, where lights are sampled
};

class NominalSourceDensity {
 public:
  // Assumes `points` samples per source, as with certificates.
  NominalSourceDensity(const PreparedScene& scene, uint32_t points)
      : scene_(&scene), points_(points) {}
  // Also covers sampled lights: directions are assumed to be chosen in proportion to the unoccluded
  // light that a matte surface gets from them. This holds for primitives without sources and, with
  // are_sources_drawn, for all sources but sky patches. `groups` must contain all such lights and
  // outlive this object.
  NominalSourceDensity(const PreparedScene& scene, uint32_t points, const LightGroups& groups,
                       bool are_sources_drawn);

  SurfacePlace place(const Vec3& x, const Vec3& n) const;
  // density(): density in the unit direction wi, which is density_of() × n · wi. The light of a sky
  // patch is taken to come from its centre.
  float density_of(const CertifiedSource& source, const SurfacePlace& at) const;
  float density(const CertifiedSource& source, const SurfacePlace& at, const Vec3& wi) const;
  // Density for a sampled primitive that has no source.
  float density(uint32_t primitive, const SurfacePlace& at, const Vec3& wi) const;

 private:
  float density_of_drawn(float radiance, const SurfacePlace& at) const;

  const PreparedScene* scene_;
  uint32_t points_;
  const LightGroups* drawn_ = nullptr;  // null: no light is sampled
  bool are_sources_drawn_ = false;
};

}  // namespace troffer
