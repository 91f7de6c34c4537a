// The sheen of cloth: fibres that stand up from the surface [1], with the shadowing of
// KHR_materials_sheen's appendix, which is fitted to [1].
// References: [1] Estevez & Kulla, "Production Friendly Microfacet Sheen BRDF", SIGGRAPH 2017
//   course.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/rgb.h"
#include "base/units.h"
#include "base/vec.h"
#include "bsdf/albedo_table.h"

namespace troffer {

// Smaller widths are clamped to this. Narrower lobes scatter more energy than arrives (1.1 times at
// 0.0225, 1.4 times at 0.01); at this width the lobe scatters all of it at the horizon.
constexpr float least_sheen_alpha = 0.04f;

// Density of normals whose sine of inclination is s [1, Eq. 2].
inline float sheen_distribution(float s, float alpha) {
  const float power = 1 / alpha;
  return (2 + power) * std::pow(std::max(s, 1e-6f), power) * (0.5f * inv_pi_f);
}

// Lambda of a direction of cosine c in [0,1] [1, §3.2].
inline float sheen_lambda(float c, float alpha) {
  const float t = sqr(1 - alpha);
  const auto fit = [t](float x) {
    const float a = lerp(21.5473f, 25.3245f, t), b = lerp(3.82987f, 3.32435f, t),
                c_ = lerp(0.19823f, 0.16801f, t), d = lerp(-1.97760f, -1.27393f, t),
                e = lerp(-4.32054f, -4.85967f, t);
    return a / (1 + b * std::pow(std::max(x, 1e-6f), c_)) + d * x + e;
  };
  return std::exp(c < 0.5f ? fit(c) : 2 * fit(0.5f) - fit(1 - c));
}

// Returns f of a white sheen for directions o and i above the surface. The factor 1 / (4 cos cos)
// with shadowing is at most 1, as the extension clamps it.
inline float sheen_value(const Vec3& o, const Vec3& i, float alpha) {
  const Vec3 h = o + i;
  const float len2 = length_squared(h);
  if (!(len2 > 1e-20f) || !(o.z > 0 && i.z > 0)) return 0;
  const float s = std::sqrt(std::max(0.0f, (h.x * h.x + h.y * h.y) / len2));
  const float shadowing = 1 + sheen_lambda(o.z, alpha) + sheen_lambda(i.z, alpha);
  return sheen_distribution(s, alpha) * std::min(1 / (shadowing * 4 * o.z * i.z), 1.0f);
}

// A sheen over all lobes of a Bsdf. It leaves 1 - its albedo in its largest colour channel, as the
// extension defines. Solid glass has it on the outside, a sheet of glass on both sides.
struct SheenLayer {
  float share = 0;       // largest colour channel; 0: no sheen
  bool is_shown = true;  // its own lobe counts, not only its attenuation
  AlbedoRow white;       // albedo of a white sheen
  Rgb colour;
  float alpha = 1;

  bool has_lobe() const { return share > 0 && is_shown; }
  float pass(const CosineCoordinate& cosine) const {
    return share > 0 ? std::max(0.0f, 1 - share * white.at(cosine)) : 1.0f;
  }
};

}  // namespace troffer
