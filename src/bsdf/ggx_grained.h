// GGX with two widths: along the x axis of the local frame and across it. Bsdfs with a grain use
// it. With equal widths the functions agree with those of ggx.h, whose conventions apply.
// References: as in ggx.h; [2] has Smith's Lambda for two widths, Eq. 86; [4] their bound.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "base/vec.h"

namespace troffer {

struct GgxWidths {
  float along = 1, across = 1;
};

// Length of w after stretching the surface to a hemisphere: sqrt(cos² + (alpha sin)²), alpha being
// the width in the direction of w. Lambda = (length / |cos| - 1) / 2.
inline float ggx_stretched(const Vec3& w, const GgxWidths& a) {
  return std::sqrt(w.z * w.z + sqr(a.along * w.x) + sqr(a.across * w.y));
}

inline float ggx_distribution(const Vec3& m, const GgxWidths& a) {
  const float t = sqr(m.x / a.along) + sqr(m.y / a.across) + m.z * m.z;
  return m.z > 0 ? 1 / (pi_f * a.along * a.across * t * t) : 0.0f;
}

// G2(o, i) / (4 cos cos), for directions above the surface.
inline float ggx_visibility(const Vec3& o, const Vec3& i, const GgxWidths& a) {
  return 0.5f / (o.z * ggx_stretched(i, a) + i.z * ggx_stretched(o, a));
}

inline float ggx_bound(const Vec3& wo, const GgxWidths& a) {
  const float a2 = sqr(std::min(a.along, a.across));
  const float s2 = sqr(1 + std::sqrt(wo.x * wo.x + wo.y * wo.y));
  return (1 - a2) * s2 / (s2 + a2 * wo.z * wo.z);
}

inline float ggx_pdf_reflected(const Vec3& wo, const Vec3& m, const GgxWidths& a, float bound) {
  return ggx_distribution(m, a) / (2 * (bound * wo.z + ggx_stretched(wo, a)));
}

inline Vec3 ggx_sample_visible_normal(const Vec3& wo, const Vec2& u, const GgxWidths& a,
                                      float bound) {
  const Vec3 w = normalize(Vec3{a.along * wo.x, a.across * wo.y, wo.z});
  const float b = bound * w.z;
  const float z = (1 - u.y) * (1 + b) - b;
  const float r = std::sqrt(std::max(0.0f, 1 - z * z)), phi = 2 * pi_f * u.x;
  const Vec3 h = Vec3{r * std::cos(phi), r * std::sin(phi), z} + w;
  const Vec3 m{a.along * h.x, a.across * h.y, std::max(h.z, 0.0f)};
  const float len2 = length_squared(m);
  return len2 > 1e-30f ? m * (1 / std::sqrt(len2)) : Vec3{0, 0, 1};
}

}  // namespace troffer
