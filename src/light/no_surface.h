// Defaults shared by light kinds without a surface: points, and lights at infinity, which have no
// position. Each kind's file derives from this and overrides what differs.
// References: [1] Khronos, glTF extension KHR_lights_punctual ("Range Property").
#pragma once

#include <cmath>
#include <limits>
#include <memory>

#include "base/units.h"
#include "light/light.h"

namespace troffer {

struct NoSurface {
  static Rgb emitted(const Scene&, const Light&, bool, const TexturePlace&, const Vec3&) {
    return Rgb{0};
  }
  static float pdf_solid_angle(const Scene&, const LightPrimitive&, const Vec3&, const Vec3&,
                               float) {
    return 0;
  }
  static Vec2 square_of_direction(const Scene&, const LightPrimitive&, const Vec3&) { return {}; }
  static Rgb radiance_at_infinity(const Scene&, const Light&, const Vec3&) { return Rgb{0}; }
  static std::unique_ptr<const DirectionTable> directions(const Scene&, const Light&) {
    return nullptr;
  }
  static CertificateShape certificate(const Scene&, const Light&) { return CertificateShape::none; }

 protected:
  static Vec3 in_own_axes(const Light& e, const Vec3& w) {
    return {dot(w, e.axes[0]), dot(w, e.axes[1]), dot(w, e.axes[2])};
  }

  static void set_point(LightPrimitive& p, const Vec3& position) {
    p.shape = PrimitiveShape::point;
    p.centroid = position;
    p.bounds.grow(position);
  }

  // Samples a point light at e.position with radiant intensity `intensity` towards x. A range fades
  // it by 1 - (distance / range)^4 [1]. With a focal distance f it falls off by
  // 1 / (distance + f)², as behind a reflector (Radiance's spotlight).
  static bool sample_point(const Light& e, const Vec3& x, Rgb intensity, LightSample& out) {
    const Vec3 to_point = e.position - x;
    const float d2 = length_squared(to_point);
    const float share = e.range > 0 ? 1 - sqr(d2 / sqr(e.range)) : 1;
    if (!(d2 > 0) || !(share > 0) || intensity.is_black()) return false;
    out = {};
    out.point = e.position;
    out.distance = std::sqrt(d2);
    out.wi = to_point * (1 / out.distance);
    const float falloff = e.focal_distance > 0 ? sqr(out.distance + e.focal_distance) : d2;
    out.radiance = intensity * (share / falloff);
    out.pdf_solid_angle = 1;
    out.is_delta = true;
    return true;
  }

  // Samples a direction by the piece's table; the radiance remains to be set. Returns false if the
  // density is zero.
  static bool sample_table(const Light& e, const LightPrimitive& p, const Vec2& u,
                           LightSample& out) {
    float pdf = 0;
    const Vec3 w = p.directions->sample(u, pdf);
    if (!(pdf > 0)) return false;
    sample_infinity(normalize(e.axes[0] * w.x + e.axes[1] * w.y + e.axes[2] * w.z), Rgb{0}, pdf,
                    out);
    return true;
  }

  // Sets a sample of light from infinity in direction wi.
  static void sample_infinity(const Vec3& wi, Rgb radiance, float pdf, LightSample& out) {
    out = {};
    out.wi = wi;
    out.distance = std::numeric_limits<float>::infinity();
    out.radiance = radiance;
    out.pdf_solid_angle = pdf;
  }
};

}  // namespace troffer
