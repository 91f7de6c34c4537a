// Reflecting lobes that are neither Lambertian nor glossy. A Bsdf has at most one of them. Each is
// soft enough that cosine-weighted or uniform directions sample it well. This header defines what
// each kind scatters; bsdf.cpp samples and evaluates it.
//
// lost_light: light that microfacets of a conductor scatter more than once [1], colour × g(wo)
// g(wi) / pi. g is the share that the glossy lobe loses at a cosine.
//
// lost_grained_light: the same for gloss that is wider along a grain than across it. g = 1 -
// even(c) - twice(c) cos 2φ, with φ the azimuth from the grain.
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

// A direction in the parameters of soft lobes: its cosine, and cos 2φ.
struct SoftDirection {
  CosineCoordinate cosine;
  float twice = 0;

  explicit SoftDirection(const Vec3& w) : cosine(w.z) {
    const float sine2 = w.x * w.x + w.y * w.y;
    if (sine2 > 1e-12f) twice = (w.x * w.x - w.y * w.y) / sine2;
  }
  // Averages over azimuths.
  explicit SoftDirection(float c) : cosine(c) {}
};

// Returns g for a direction on the viewer's side.
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

// Returns pi f for directions on the viewer's side, given soft_gain of both.
inline Rgb soft_value(const SoftLobe& l, float gain_o, float gain_i) {
  if (l.kind == SoftLobe::Kind::none) return Rgb{0};
  return l.colour * (gain_o * gain_i);
}

// Returns the share of energy from a direction that the lobe scatters.
inline Rgb soft_energy(const SoftLobe& l, float gain_o) {
  if (l.kind == SoftLobe::Kind::none) return Rgb{0};
  return l.colour * (gain_o * l.mean);
}

// True if soft_value is colour × gain_o × gain_i with gains as for lost_light. evaluate_many can
// then use vector instructions.
inline bool is_product(const SoftLobe& l) {
  return l.kind == SoftLobe::Kind::none || l.kind == SoftLobe::Kind::lost_light;
}

}  // namespace troffer
