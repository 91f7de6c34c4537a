// Glass under a clear coat. Solid glass has the coat on its outside, a sheet on both sides.
//
// A face reflects R and transmits T. The coat over it reflects r and passes t = 1 - r. All
// inter-reflections between coat and face are summed [1]:
//   from outside  r + t² R / (1 - r R) is reflected,  t T / (1 - r R) transmitted;
//   from within   R + T² r / (1 - r R),               the same.
// A sheet is a face with a coat on either side. Lossless glass stays lossless, and a pane of solid
// glass with two faces matches the sheet that represents it. The first term r is the coat's own
// lobe (clear_coat.h); this file computes the rest.
//
// t belongs to directions outside the glass. Light that crosses takes the t of its outer direction
// (for a sheet the smaller of both), so that f is reciprocal. Light reflected outside takes the
// smaller t of both directions. Light reflected inside takes the larger t of the directions into
// which the facet refracts them. This never exceeds the incoming energy and is exact for sharp
// lobes. All use the base's normal.
//
// References: [1] Stokes, "On the Intensity of the Light Reflected from or Transmitted through a
//   Pile of Plates", Proc. Royal Society 11, 1862.
#pragma once

#include <algorithm>
#include <cmath>

#include "bsdf/bsdf.h"
#include "bsdf/fresnel.h"
#include "bsdf/split.h"

namespace troffer {

// Sets wi to the refraction of wo at a normal m, c = dot(wo, m); false on total reflection.
inline bool refract(const Vec3& wo, const Vec3& m, float c, float eta, Vec3& wi) {
  const float cos_t = refracted_cosine(c, eta);
  if (cos_t < 0) return false;
  wi = normalize(m * (c / eta - cos_t) - wo * (1 / eta));
  return true;
}

inline bool is_coated_glass(const Bsdf& b) {
  return b.has_transmission && b.clear.share > 0;
}

// Returns how a facet at incident cosine c divides the light; t is the coat's pass.
inline Split coated_split(const Bsdf& b, float c, float t) {
  const Split bare = split_at(b, c);
  const Rgb opaque = schlick_or_film(b, c);
  const float r = 1 - t, weight = b.glass_weight, outer = b.is_within ? 1 : t;
  Split s;
  for (size_t i = 0; i < 3; ++i) {
    float back = std::max(bare.reflected[i] - opaque[i], 0.0f) / weight;
    float through = bare.transmitted[i] / weight;
    if (b.is_thin || b.is_within) {  // the coat behind
      const float fro = 1 / (1 - r * back);
      back += through * through * r * fro;
      through *= t * fro;
    }
    if (!b.is_within) {  // the one before
      const float fro = 1 / std::max(1 - r * back, 1e-6f);
      back *= t * t * fro;
      through *= t * fro;
    }
    s.reflected[i] = opaque[i] * outer + back * weight;
    s.transmitted[i] = through * weight;
  }
  return s;
}

// Returns the coat's pass for a facet as if it were the whole surface.
inline float facet_pass(const Bsdf& b, float c) {
  if (!b.is_within) return b.clear.pass(c);
  const float outside = refracted_cosine(c, b.eta);
  return outside > 0 ? b.clear.pass(outside) : 1.0f;
}

// Returns how facets parallel to the surface divide the light, coats of glass included.
inline Split facet_split(const Bsdf& b, float c) {
  return is_coated_glass(b) ? coated_split(b, c, facet_pass(b, c)) : split_at(b, c);
}

// Returns the share of light that the coat passes, for two directions on the viewer's side that
// mirror each other about the microfacet normal m, with cosine c to it.
inline float reflected_pass(const Bsdf& b, const Vec3& wo, const Vec3& wi, const Vec3& m, float c) {
  if (!b.is_within) return std::min(b.clear.pass(wo.z), b.clear.pass(wi.z));
  float pass = 0;
  for (const Vec3* w : {&wo, &wi}) {
    Vec3 out;
    // Light that does not leave the glass does not meet the coat.
    const bool is_out = refract(*w, m, c, b.eta, out) && out.z < 0;
    pass = std::max(pass, is_out ? b.clear.pass(-out.z) : 1.0f);
  }
  return pass;
}

// Returns the coat's pass for light that crosses from one side to the other.
inline float crossing_pass(const Bsdf& b, const Vec3& wo, const Vec3& wi) {
  const float near = b.is_within ? 1.0f : b.clear.pass(wo.z);
  const float far = b.is_within || b.is_thin ? b.clear.pass(-wi.z) : 1.0f;
  return std::min(near, far);
}

}  // namespace troffer
