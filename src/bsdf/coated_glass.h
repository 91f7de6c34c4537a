// Glass under a clear coat: solid glass wears it on its outside, a sheet on both of its sides.
//
// Of a face that reflects R and transmits T, under a coat that reflects r and passes t = 1 - r, all
// that goes to and fro between both is summed [1]:
//   from outside  r + t² R / (1 - r R) is reflected,  t T / (1 - r R) transmitted;
//   from within   R + T² r / (1 - r R),               the same.
// A sheet is a face with a coat before and one behind. Lossless glass keeps sending on everything,
// and a pane of solid glass with two faces does what the sheet does that stands for it. The r above
// is the coat's own lobe (clear_coat.h); the rest is told here.
//
// t is that of directions outside: of light that crosses, that of its outer direction (of a sheet,
// the smaller of both), so that f is reciprocal. What is reflected outside takes the smaller t of
// both directions, within the larger one of those into which the facet would refract either: never
// more than comes in, exact where lobes are sharp. All by the base's normal.
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

// Direction of refraction at a normal m that wo sees at cosine c; false on total reflection.
inline bool refract(const Vec3& wo, const Vec3& m, float c, float eta, Vec3& wi) {
  const float cos_t = refracted_cosine(c, eta);
  if (cos_t < 0) return false;
  wi = normalize(m * (c / eta - cos_t) - wo * (1 / eta));
  return true;
}

inline bool is_coated_glass(const Bsdf& b) {
  return b.has_transmission && b.clear.share > 0;
}

// How a facet that is met at cosine c divides the light, t the coat's pass.
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

// The coat's pass for a facet alone, were it the surface.
inline float facet_pass(const Bsdf& b, float c) {
  if (!b.is_within) return b.clear.pass(c);
  const float outside = refracted_cosine(c, b.eta);
  return outside > 0 ? b.clear.pass(outside) : 1.0f;
}

// What light goes by, below all coats, of facets that stand as the surface does.
inline Split facet_split(const Bsdf& b, float c) {
  return is_coated_glass(b) ? coated_split(b, c, facet_pass(b, c)) : split_at(b, c);
}

// Of two directions on the viewer's side, one the mirror image of the other at normal m, which they
// meet at cosine c.
inline float reflected_pass(const Bsdf& b, const Vec3& wo, const Vec3& wi, const Vec3& m, float c) {
  if (!b.is_within) return std::min(b.clear.pass(wo.z), b.clear.pass(wi.z));
  float pass = 0;
  for (const Vec3* w : {&wo, &wi}) {
    Vec3 out;
    // What would not come out meets no coat.
    const bool is_out = refract(*w, m, c, b.eta, out) && out.z < 0;
    pass = std::max(pass, is_out ? b.clear.pass(-out.z) : 1.0f);
  }
  return pass;
}

// Of light that crosses from one side to the other.
inline float crossing_pass(const Bsdf& b, const Vec3& wo, const Vec3& wi) {
  const float near = b.is_within ? 1.0f : b.clear.pass(wo.z);
  const float far = b.is_within || b.is_thin ? b.clear.pass(-wi.z) : 1.0f;
  return std::min(near, far);
}

}  // namespace troffer
