// Lobes that only reflect, and are neither Lambert's nor a mirror's blur: all that is known of each
// kind stands here. Each is so soft that directions by a cosine, or evenly spread, sample it well:
// it says what it scatters, and bsdf.cpp does the rest. A Bsdf has one of them at most.
//
// lost_light: what microfacets of a conductor scatter more than once [1]: colour × g(wo) g(wi) /
// pi, g the share that the glossy lobe loses at a cosine.
//
// References: [1] Kulla & Conty, "Revisiting Physically Based Shading at Imageworks", SIGGRAPH 2017
//   course.
#pragma once

#include <algorithm>
#include <cstdint>

#include "base/rgb.h"
#include "base/vec.h"
#include "bsdf/albedo_table.h"

namespace troffer {

struct SoftLobe {
  enum class Kind : uint8_t { none, lost_light };
  Kind kind = Kind::none;
  Rgb colour;
  // lost_light:
  float mean = 0;    // cosine-weighted mean of g over the hemisphere
  AlbedoRow glossy;  // g = 1 - this
};

// What the lobe keeps of a direction on the viewer's side, of this cosine.
inline float soft_gain(const SoftLobe& l, const CosineCoordinate& cosine) {
  if (l.kind != SoftLobe::Kind::lost_light || l.glossy.values == nullptr) return 0;
  return std::max(0.0f, 1 - l.glossy.at(cosine));
}

// pi f for directions on the viewer's side, with soft_gain of both.
inline Rgb soft_value(const SoftLobe& l, const Vec3& /*wo*/, const Vec3& /*wi*/, float gain_o,
                      float gain_i) {
  return l.kind == SoftLobe::Kind::lost_light ? l.colour * (gain_o * gain_i) : Rgb{0};
}

// Share of the energy from wo that it scatters. cos_o: wo.z.
inline Rgb soft_energy(const SoftLobe& l, float /*cos_o*/, float gain_o) {
  return l.kind == SoftLobe::Kind::lost_light ? l.colour * (gain_o * l.mean) : Rgb{0};
}

// Whether soft_value is colour × gain_o × gain_i, each gain as of lost_light: then evaluate_many
// takes several directions to a vector register.
inline bool is_product(const SoftLobe& l) {
  return l.kind == SoftLobe::Kind::none || l.kind == SoftLobe::Kind::lost_light;
}

}  // namespace troffer
