// The isotropic GGX microfacet distribution with Smith's height-correlated shadowing and masking,
// and sampling of the normals that a direction sees. Directions are unit vectors in the local
// frame whose z is the macroscopic normal.
// References: [1] Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR
//   2007. [2] Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs",
//   JCGT 3(2), 2014. [3] Dupuy & Benyoub, "Sampling Visible GGX Normals with Spherical Caps", HPG
//   2023. [4] Eto & Tokuyoshi, "Bounded VNDF Sampling for Smith-GGX Reflections", SIGGRAPH Asia
//   2023 (technical communications).
#pragma once

#include <cmath>

#include "base/units.h"
#include "base/vec.h"

namespace troffer {

// Density of normals per unit solid angle and unit macroscopic area [1, Eq. 33].
inline float ggx_distribution(const Vec3& m, float alpha) {
  const float a2 = alpha * alpha;
  const float t = (m.x * m.x + m.y * m.y) / a2 + m.z * m.z;
  return m.z > 0 ? 1 / (pi_f * a2 * t * t) : 0.0f;
}

// Smith's Lambda for a direction with |cos theta| = c > 0 [2, Eq. 72].
inline float ggx_lambda(float c, float alpha) {
  const float tan2 = std::max(0.0f, 1 - c * c) / (c * c);
  return 0.5f * (std::sqrt(1 + alpha * alpha * tan2) - 1);
}

// G2(o, i) / (4 o i) for cosines o, i > 0, height-correlated [2, Eq. 99]; finite at grazing angles
// because the cosines of numerator and denominator cancel.
inline float ggx_visibility(float o, float i, float alpha) {
  const float a2 = alpha * alpha, b2 = 1 - a2;
  return 0.5f / (o * std::sqrt(a2 + b2 * i * i) + i * std::sqrt(a2 + b2 * o * o));
}

// Returns the bound of the spherical cap that excludes most reflections below the horizon [4]; 1
// keeps the whole cap [3].
inline float ggx_bound(const Vec3& wo, float alpha) {
  const float a2 = alpha * alpha;
  const float s2 = sqr(1 + std::sqrt(wo.x * wo.x + wo.y * wo.y));
  return (1 - a2) * s2 / (s2 + a2 * wo.z * wo.z);
}

// Density of m / (4 wo·m), which is the density of the reflected direction per solid angle, for
// ggx_sample_visible_normal with the same bound. Per solid angle of m, multiply by 4 wo·m.
// With bound 1 it equals G1(wo) D(m) / (4 cos).
inline float ggx_pdf_reflected(const Vec3& wo, const Vec3& m, float alpha, float bound) {
  const float t = std::sqrt(alpha * alpha * (wo.x * wo.x + wo.y * wo.y) + wo.z * wo.z);
  return ggx_distribution(m, alpha) / (2 * (bound * wo.z + t));
}

// Samples a unit normal visible from wo (wo.z > 0) [3; 4].
inline Vec3 ggx_sample_visible_normal(const Vec3& wo, const Vec2& u, float alpha, float bound) {
  const Vec3 w = normalize(Vec3{alpha * wo.x, alpha * wo.y, wo.z});
  const float b = bound * w.z;
  const float z = (1 - u.y) * (1 + b) - b;
  const float r = std::sqrt(std::max(0.0f, 1 - z * z)), phi = 2 * pi_f * u.x;
  const Vec3 h = Vec3{r * std::cos(phi), r * std::sin(phi), z} + w;
  const Vec3 m{alpha * h.x, alpha * h.y, std::max(h.z, 0.0f)};
  const float len2 = length_squared(m);
  return len2 > 1e-30f ? m * (1 / std::sqrt(len2)) : Vec3{0, 0, 1};
}

}  // namespace troffer
