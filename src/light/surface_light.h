// Lights with a surface: polygons, disks, spheres and meshes. They emit diffusely, or as the
// opening of a photometric web, where Light::radiance is a factor. Their pieces are sampled by
// light_sample.h; light.h uses this file for their kinds.
#pragma once

#include "light/light.h"
#include "light/web.h"

namespace troffer {

struct SurfaceLight {
  static Rgb emitted(const Scene& scene, const Light& e, bool is_front, const TexturePlace& uv,
                     const Vec3& towards) {
    // the same in all directions
    if (e.web == no_web) return emitted_radiance(scene, e, is_front, uv);
    if (!is_front && !e.is_two_sided) return Rgb{0};
    const Vec3 w{dot(towards, e.axes[0]), dot(towards, e.axes[1]), dot(towards, e.axes[2])};
    return e.radiance * radiance(scene.webs[size_t(e.web)], w);
  }

  // Sets the radiance of a point that light_sample.h has sampled.
  static void finish(const Scene& scene, const LightPrimitive& p, LightSample& s) {
    s.is_delta = false;
    s.radiance = p.is_textured
                     ? emitted(scene, scene.lights[p.light], s.is_front, s.texture_uv, -s.wi)
                     : p.mean_radiance;
  }

  static bool sample(const Scene& scene, const LightPrimitive& p, const Vec3& x, const Vec2& u,
                     LightSample& out) {
    if (!troffer::sample(p, x, u, out)) return false;
    finish(scene, p, out);
    return true;
  }
  static float pdf_solid_angle(const Scene& /*scene*/, const LightPrimitive& p, const Vec3& x,
                               const Vec3& wi, float distance) {
    return troffer::pdf_solid_angle(p, x, wi, distance);
  }
  static Vec2 square_of_direction(const Scene&, const LightPrimitive&, const Vec3&) { return {}; }
  static Rgb radiance_at_infinity(const Scene&, const Light&, const Vec3&) { return Rgb{0}; }
  static std::unique_ptr<const DirectionTable> directions(const Scene&, const Light&) {
    return nullptr;
  }
  static void bound(const Scene&, const Light&, const Box&, LightPrimitive&) {
  }  // not used: surface lights may have more than one piece

  static CertificateShape certificate(const Scene& scene, const Light& e) {
    if (e.kind != LightKind::sphere) return CertificateShape::flat;
    const bool is_inwards = e.is_two_sided || scene.spheres[e.geometry].is_inside_out;
    return is_inwards ? CertificateShape::none : CertificateShape::sphere;
  }
};

}  // namespace troffer
