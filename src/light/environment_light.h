// The same radiance from everywhere beyond the scene.
#pragma once

#include "base/units.h"
#include "base/warp.h"
#include "light/no_surface.h"

namespace troffer {

struct EnvironmentLight : NoSurface {
  // Through a sphere of radius R around the scene enters pi L on 4 pi R².
  static void bound(const Light& e, const Box& scene, LightPrimitive& p) {
    p.shape = PrimitiveShape::infinite;
    p.mean_radiance = e.radiance;
    p.power = p.tree_power = sqr(pi_f * scene.diagonal()) * luminance(e.radiance);
  }
  // Uniform over all directions, since the receiver may transmit light from behind.
  static bool sample(const Scene& scene, const LightPrimitive& p, const Vec3& /*x*/, const Vec2& u,
                     LightSample& out) {
    sample_infinity(sphere_from_square(u), scene.lights[p.light].radiance, inv_pi_f / 4, out);
    return true;
  }
  static float pdf_solid_angle(const Scene&, const LightPrimitive&, const Vec3&, const Vec3&,
                               float) {
    return inv_pi_f / 4;
  }
  static Rgb radiance_at_infinity(const Light& e, const Vec3& /*wi*/) { return e.radiance; }
};

}  // namespace troffer
