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
  enum class Kind : uint8_t { none, lost_light, lost_grained_light };
  Kind kind = Kind::none;
  Rgb colour;
  // lost_light:
  float mean = 0;    // cosine-weighted mean of g over the hemisphere
  AlbedoRow glossy;  // g = 1 - this; lost_grained_light: even
  // lost_grained_light:
  AlbedoRow twice;
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

// What the lobe keeps of a direction on the viewer's side.
inline float soft_gain(const SoftLobe& l, const SoftDirection& w) {
  switch (l.kind) {
    case SoftLobe::Kind::none:
      return 0;
    case SoftLobe::Kind::lost_light:
      return std::max(0.0f, 1 - l.glossy.at(w.cosine));
    case SoftLobe::Kind::lost_grained_light:
      return std::max(0.0f, 1 - l.glossy.at(w.cosine) - l.twice.at(w.cosine) * w.twice);
  }
  return 0;
}

// pi f for directions on the viewer's side, with soft_gain of both.
inline Rgb soft_value(const SoftLobe& l, float gain_o, float gain_i) {
  if (l.kind == SoftLobe::Kind::none) return Rgb{0};
  return l.colour * (gain_o * gain_i);
}

// Share of the energy from a direction that it scatters.
inline Rgb soft_energy(const SoftLobe& l, float gain_o) {
  if (l.kind == SoftLobe::Kind::none) return Rgb{0};
  return l.colour * (gain_o * l.mean);
}

// Whether soft_value is colour × gain_o × gain_i, each gain as of lost_light: then evaluate_many
// takes several directions to a vector register.
inline bool is_product(const SoftLobe& l) {
  return l.kind == SoftLobe::Kind::none || l.kind == SoftLobe::Kind::lost_light;
}

}  // namespace troffer
