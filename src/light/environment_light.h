// Light from everywhere beyond the scene: of uniform radiance, or given by an image. One of the
// light kinds behind light.h.
#pragma once

#include "base/units.h"
#include "base/warp.h"
#include "light/environment_image.h"
#include "light/no_surface.h"

namespace troffer {

struct EnvironmentLight : NoSurface {
  static std::unique_ptr<const DirectionTable> directions(const Scene& scene, const Light& e) {
    if (e.environment == no_environment) return nullptr;
    return std::make_unique<const DirectionTable>(
        direction_table(scene.environments[size_t(e.environment)]));
  }

  // The power through a sphere of radius R around the scene is pi R² times the integral of the
  // radiance over all directions.
  static void bound(const Scene&, const Light& e, const Box& bounds, LightPrimitive& p) {
    p.shape = PrimitiveShape::infinite;
    const float mean = p.directions ? float(p.directions->integral() / (4 * pi)) : 1;
    p.mean_radiance = e.radiance * mean;
    p.power = p.tree_power = sqr(pi_f * bounds.diagonal()) * luminance(p.mean_radiance);
  }
  // Samples all directions, since the receiver may transmit light from behind: uniformly, or in
  // proportion to the image.
  static bool sample(const Scene& scene, const LightPrimitive& p, const Vec3& /*x*/, const Vec2& u,
                     LightSample& out) {
    const Light& e = scene.lights[p.light];
    if (p.directions == nullptr) {
      sample_infinity(sphere_from_square(u), e.radiance, inv_pi_f / 4, out);
      return true;
    }
    if (!sample_table(e, p, u, out)) return false;
    out.radiance = radiance_at_infinity(scene, e, out.wi);
    return true;
  }
  static float pdf_solid_angle(const Scene& scene, const LightPrimitive& p, const Vec3&,
                               const Vec3& wi, float) {
    return p.directions ? p.directions->pdf(in_own_axes(scene.lights[p.light], wi)) : inv_pi_f / 4;
  }
  static Vec2 square_of_direction(const Scene& scene, const LightPrimitive& p, const Vec3& wi) {
    return p.directions ? p.directions->square_of(in_own_axes(scene.lights[p.light], wi))
                        : square_from_sphere(wi);
  }
  static Rgb radiance_at_infinity(const Scene& scene, const Light& e, const Vec3& wi) {
    if (e.environment == no_environment) return e.radiance;
    return e.radiance *
           radiance_towards(scene.environments[size_t(e.environment)], in_own_axes(e, wi));
  }
};

}  // namespace troffer
