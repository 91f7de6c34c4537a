// Lobes that only reflect, and are neither Lambert's nor a mirror's blur: all that is known of each
// kind stands here. Each is so soft that directions by a cosine, or evenly spread, sample it well:
// it says what it scatters, and bsdf.cpp does the rest. A Bsdf has one of them at most.
//
// lost_light: what microfacets of a conductor scatter more than once [1]: colour × g(wo) g(wi) /
// pi, g the share that the glossy lobe loses at a cosine.
//
// lost_grained_light: the same where gloss is wider along a grain than across it: g is 1 - even(c)
// - twice(c) cos 2φ, φ the azimuth from the grain.
//
// sheen: of cloth (bsdf/sheen.h), over all else, of which it leaves 1 - its albedo: SheenCover.
//
// References: [1] Kulla & Conty, "Revisiting Physically Based Shading at Imageworks", SIGGRAPH 2017
//   course.
#pragma once

#include <algorithm>
#include <cstdint>

#include "base/rgb.h"
#include "base/vec.h"
#include "bsdf/albedo_table.h"
#include "bsdf/sheen.h"

namespace troffer {

struct SoftLobe {
  enum class Kind : uint8_t { none, lost_light, lost_grained_light, sheen };
  Kind kind = Kind::none;
  Rgb colour;
  // lost_light:
  float mean = 0;    // cosine-weighted mean of g over the hemisphere
  AlbedoRow glossy;  // g = 1 - this; lost_grained_light: even; sheen: its albedo where it is white
  // lost_grained_light:
  AlbedoRow twice;
  // sheen:
  float alpha = 1;
};

// A direction as soft lobes know it: its cosine, and cos 2φ.
struct SoftDirection {
  CosineCoordinate cosine;
  float twice = 0;

  explicit SoftDirection(const Vec3& w) : cosine(w.z) {
    const float sine2 = w.x * w.x + w.y * w.y;
    if (sine2 > 1e-12f) twice = (w.x * w.x - w.y * w.y) / sine2;
  }
  // In the mean over azimuths.
  explicit SoftDirection(float c) : cosine(c) {}
};

// What a sheen leaves for all that lies under it.
struct SheenCover {
  float share = 0;  // the largest of its colours; 0: there is none
  AlbedoRow white;  // its albedo where it is white

  float pass(const CosineCoordinate& cosine) const {
    return share > 0 ? std::max(0.0f, 1 - share * white.at(cosine)) : 1.0f;
  }
};

inline bool is_lost_light(const SoftLobe& l) {
  return l.kind == SoftLobe::Kind::lost_light || l.kind == SoftLobe::Kind::lost_grained_light;
}

// What the lobe keeps of a direction on the viewer's side.
inline float soft_gain(const SoftLobe& l, const SoftDirection& w) {
  switch (l.kind) {
    case SoftLobe::Kind::none:
      return 0;
    case SoftLobe::Kind::sheen:
      return l.glossy.at(w.cosine);
    case SoftLobe::Kind::lost_light:
      return std::max(0.0f, 1 - l.glossy.at(w.cosine));
    case SoftLobe::Kind::lost_grained_light:
      return std::max(0.0f, 1 - l.glossy.at(w.cosine) - l.twice.at(w.cosine) * w.twice);
  }
  return 0;
}

// pi f for directions on the viewer's side, with soft_gain of both.
inline Rgb soft_value(const SoftLobe& l, const Vec3& wo, const Vec3& wi, float gain_o,
                      float gain_i) {
  if (l.kind == SoftLobe::Kind::none) return Rgb{0};
  if (l.kind == SoftLobe::Kind::sheen) return l.colour * (pi_f * sheen_value(wo, wi, l.alpha));
  return l.colour * (gain_o * gain_i);
}

// Share of the energy from a direction that it scatters.
inline Rgb soft_energy(const SoftLobe& l, float gain_o) {
  if (l.kind == SoftLobe::Kind::none) return Rgb{0};
  return l.colour * (l.kind == SoftLobe::Kind::sheen ? gain_o : gain_o * l.mean);
}

// Whether soft_value is colour × gain_o × gain_i, each gain as of lost_light: then evaluate_many
// takes several directions to a vector register.
inline bool is_product(const SoftLobe& l) {
  return l.kind == SoftLobe::Kind::none || l.kind == SoftLobe::Kind::lost_light;
}

}  // namespace troffer
