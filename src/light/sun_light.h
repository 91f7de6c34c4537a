// A disc of uniform radiance at infinity. One of the light kinds behind light.h.
#pragma once

#include "base/frame.h"
#include "base/units.h"
#include "light/no_surface.h"

namespace troffer {

struct SunLight : NoSurface {
  // 1 - cos of the angular radius, without cancellation.
  static float drop(const Light& e) { return 2 * sqr(std::sin(e.angular_radius / 2)); }
  static float solid_angle(const Light& e) { return 2 * pi_f * drop(e); }

  static void bound(const Scene& /*scene*/, const Light& e, const Box& bounds, LightPrimitive& p) {
    p.shape = PrimitiveShape::infinite;
    p.mean_radiance = e.radiance;
    // Power that enters a sphere around the scene.
    p.power = p.tree_power =
        pi_f * sqr(0.5f * bounds.diagonal()) * solid_angle(e) * luminance(e.radiance);
    p.cone_axis = e.direction;
    p.cos_cone = std::cos(e.angular_radius);
  }
  static bool sample(const Scene& scene, const LightPrimitive& p, const Vec3& /*x*/, const Vec2& u,
                     LightSample& out) {
    const Light& e = scene.lights[p.light];
    const float down = u.x * drop(e), sine = std::sqrt(down * (2 - down)), phi = 2 * pi_f * u.y;
    const Vec3 local{sine * std::cos(phi), sine * std::sin(phi), 1 - down};
    sample_infinity(Frame(-e.direction).to_world(local), e.radiance, 1 / solid_angle(e), out);
    return true;
  }
  static float pdf_solid_angle(const Scene& scene, const LightPrimitive& p, const Vec3&,
                               const Vec3& wi, float) {
    const Light& e = scene.lights[p.light];
    return is_within(e, wi) ? 1 / solid_angle(e) : 0;
  }
  static Rgb radiance_at_infinity(const Scene&, const Light& e, const Vec3& wi) {
    return is_within(e, wi) ? e.radiance : Rgb{0};
  }

 private:
  // |wi - axis|² = 2 (1 - cos). The margin keeps samples on the rim inside.
  static bool is_within(const Light& e, const Vec3& wi) {
    return length_squared(wi + e.direction) <= 2 * drop(e) * 1.0001f;
  }
};

}  // namespace troffer
