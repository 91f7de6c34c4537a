#include "certified/nominal_source_density.h"

#include <algorithm>
#include <cmath>

#include "certified/light_groups.h"
#include "certified/source_integrand.h"

namespace troffer {

namespace {

// Nominal number of samples per viewing ray for all sampled lights together. Measured:
// docs/method/cells-appendix.md, "Wide gloss seen from the side".
constexpr float drawn_points = 4;

}  // namespace

NominalSourceDensity::NominalSourceDensity(const PreparedScene& scene, uint32_t points,
                                           const LightGroups& groups, bool are_sources_drawn)
    : scene_(&scene),
      points_(points),
      drawn_(are_sources_drawn || !groups.have_all_sources() ? &groups : nullptr),
      are_sources_drawn_(are_sources_drawn) {}

SurfacePlace NominalSourceDensity::place(const Vec3& x, const Vec3& n) const {
  return {x, n, drawn_ != nullptr ? drawn_->all_light(x, n) : 0};
}

float NominalSourceDensity::density_of_drawn(float radiance, const SurfacePlace& at) const {
  return at.all_light > 0 ? drawn_points * radiance / at.all_light : 0;
}

float NominalSourceDensity::density_of(const CertifiedSource& source,
                                       const SurfacePlace& at) const {
  if (source.far != nullptr) {
    // A patch centred on the horizon is about half above it.
    const float half_width = std::sqrt(source.solid_angle * inv_pi_f) * 0.5f;
    const float cosine = std::max(dot(at.n, source.towards), half_width);
    const float projected = source.solid_angle * cosine;
    return projected > 0 ? float(points_) / projected : 0;
  }
  if (are_sources_drawn_) return density_of_drawn(luminance(source.radiance), at);
  const auto unoccluded = float(source.unoccluded(Vec3d(at.x), Vec3d(at.n)));
  return unoccluded > 0 ? float(points_) / unoccluded : 0;
}

float NominalSourceDensity::density(const CertifiedSource& source, const SurfacePlace& at,
                                    const Vec3& wi) const {
  const float cosine = dot(at.n, wi);
  return cosine > 0 ? density_of(source, at) * cosine : 0;
}

float NominalSourceDensity::density(uint32_t primitive, const SurfacePlace& at,
                                    const Vec3& wi) const {
  const float radiance = luminance(scene_->primitives[primitive].mean_radiance);
  return density_of_drawn(radiance, at) * std::max(dot(at.n, wi), 0.0f);
}

}  // namespace troffer
