// A sky given by formula, and the ground below it. One of the light kinds behind light.h.
//
// One formula covers the CIE general skies [1] and Perez' all-weather skies [2]: a gradation from
// zenith to horizon, times an indicatrix around the sun. They differ in the constant k
// (daylight/sky_model.h).
//
// References: [1] CIE S 011/E:2003 (ISO 15469:2004), "Spatial distribution of daylight: CIE
//   standard general sky".
//   [2] Perez, Seals & Michalsky, "All-weather model for sky luminance distribution", Solar
//   Energy 50(3), 1993, Eq. 1.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "light/no_surface.h"

namespace troffer {

// Relative luminance by the cosines of the angles from the zenith (> 0) and from the sun. Negative
// values become 0.
template <class T>
T relative_luminance(const SkyShape& s, T cos_zenith, T cos_sun) {
  // Perez' b may be positive, because his measurements end above the horizon.
  const T cosine = std::max(cos_zenith, T(0.01));
  const T gradation = 1 + T(s.a) * std::exp(T(s.b) / cosine);
  const T clamped = std::clamp(cos_sun, T(-1), T(1));
  const T indicatrix =
      T(s.k) + T(s.c) * std::exp(T(s.d) * std::acos(clamped)) + T(s.e) * clamped * clamped;
  return std::max(T(0), gradation * indicatrix);
}

struct SkyLight : NoSurface {
  // Returns a lat-long table of the sky's luminance.
  static std::unique_ptr<const DirectionTable> directions(const Scene& scene, const Light& e) {
    constexpr int height = 192, width = 2 * height;
    std::vector<float> luminances(size_t(width) * size_t(height));
    double sum = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const Vec3 w = lat_long_direction(
            {(float(x) + 0.5f) / float(width), (float(y) + 0.5f) / float(height)});
        const Vec3 world = e.axes[0] * w.x + e.axes[1] * w.y + e.axes[2] * w.z;
        float& at = luminances[size_t(y) * width + size_t(x)];
        at = luminance(radiance_at_infinity(scene, e, world));
        sum += double(at);
      }
    // A floor, because a sky that is dark at all texel centres may still shine between them.
    const auto least = float(1e-3 * sum / (double(width) * double(height)));
    for (size_t i = 0; i < luminances.size() / 2; ++i)
      luminances[i] = std::max(luminances[i], least);
    return std::make_unique<const DirectionTable>(SphereMap::lat_long, width, height, luminances);
  }
  static void bound(const Scene&, const Light&, const Box& bounds, LightPrimitive& p) {
    p.shape = PrimitiveShape::infinite;
    p.mean_radiance = Rgb{float(p.directions->integral() / (4 * pi))};
    p.power = p.tree_power = sqr(pi_f * bounds.diagonal()) * luminance(p.mean_radiance);
  }
  static bool sample(const Scene& scene, const LightPrimitive& p, const Vec3& /*x*/, const Vec2& u,
                     LightSample& out) {
    const Light& e = scene.lights[p.light];
    if (!sample_table(e, p, u, out)) return false;
    out.radiance = radiance_at_infinity(scene, e, out.wi);
    return true;
  }
  static float pdf_solid_angle(const Scene& scene, const LightPrimitive& p, const Vec3&,
                               const Vec3& wi, float) {
    return p.directions->pdf(in_own_axes(scene.lights[p.light], wi));
  }
  static Vec2 square_of_direction(const Scene& scene, const LightPrimitive& p, const Vec3& wi) {
    return p.directions->square_of(in_own_axes(scene.lights[p.light], wi));
  }
  static Rgb radiance_at_infinity(const Scene&, const Light& e, const Vec3& wi) {
    const float up = dot(wi, e.axes[2]);
    if (!(up > 0)) return e.sky.ground;
    return e.radiance * relative_luminance(e.sky, up, -dot(wi, e.direction));
  }
};

}  // namespace troffer
