// What kinds of light without a surface share: points are deltas in direction, and lights at
// infinity have no position. A kind's file derives from this and says what differs.
#pragma once

#include <cmath>
#include <limits>

#include "light/light.h"

namespace troffer {

struct NoSurface {
  static Rgb emitted(const Scene&, const Light&, bool, const Vec2&, const Vec3&) { return Rgb{0}; }
  static float pdf_solid_angle(const Scene&, const LightPrimitive&, const Vec3&, const Vec3&,
                               float) {
    return 0;
  }
  static Rgb radiance_at_infinity(const Light&, const Vec3&) { return Rgb{0}; }
  static CertificateShape certificate(const Scene&, const Light&) { return CertificateShape::none; }

 protected:
  static void set_point(LightPrimitive& p, const Vec3& position) {
    p.shape = PrimitiveShape::point;
    p.centroid = position;
    p.bounds.grow(position);
  }

  // A point of radiant intensity `intensity` towards x.
  static bool sample_point(const Vec3& position, const Vec3& x, Rgb intensity, LightSample& out) {
    const Vec3 to_point = position - x;
    const float d2 = length_squared(to_point);
    if (!(d2 > 0) || intensity.is_black()) return false;
    out = {};
    out.point = position;
    out.distance = std::sqrt(d2);
    out.wi = to_point * (1 / out.distance);
    out.radiance = intensity / d2;
    out.pdf_solid_angle = 1;
    out.is_delta = true;
    return true;
  }

  // Light from infinity in the direction wi.
  static void sample_infinity(const Vec3& wi, Rgb radiance, float pdf, LightSample& out) {
    out = {};
    out.wi = wi;
    out.distance = std::numeric_limits<float>::infinity();
    out.radiance = radiance;
    out.pdf_solid_angle = pdf;
  }
};

}  // namespace troffer
