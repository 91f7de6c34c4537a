// Division of light by one microfacet of a Bsdf's glossy lobe into reflected and transmitted
// shares, thin films and absorbing sheets included. bsdf.cpp uses it to evaluate and sample,
// choice.h for albedos. Cosines are those of incidence on the microfacet.
#pragma once

#include <algorithm>
#include <cmath>

#include "bsdf/bsdf.h"
#include "bsdf/fresnel.h"

namespace troffer {

// Shares that a microfacet reflects and transmits at a cosine of incidence on it.
struct Split {
  Rgb reflected, transmitted;
  // Returns the probability with which sampling follows the reflection.
  float reflection_share() const {
    const float r = average(reflected), t = average(transmitted);
    return t > 0 ? r / (r + t) : 1.0f;
  }
};

// Returns the reflectance of glass under a thin film; r is its reflectance without the film. From
// inside, the film's reflectance is that at the refracted angle outside.
inline Rgb glass_or_film(const Bsdf& b, float c, float r) {
  const bool is_inside = !b.is_thin && b.eta < 1;
  const Rgb f0{normal_reflectance(b.eta)};
  const Rgb filmed = film_reflectance(b.film, f0, is_inside ? refracted_cosine(c, b.eta) : c);
  return Rgb{r} + (filmed - Rgb{r}) * b.film.share;
}

// Absorbing thin sheet: the path inside is longer at oblique angles. If reflection is scaled down,
// the unreflected part is transmitted.
inline Split absorbing_sheet(const Bsdf& b, float c) {
  const float way = 1 / std::max(refracted_cosine(c, b.eta), 1e-4f);
  const Rgb face = b.film.share > 0 ? glass_or_film(b, c, fresnel_dielectric(c, b.eta)) : Rgb{0};
  Split s;
  for (size_t i = 0; i < 3; ++i) {
    const float a = std::exp(-b.absorbed[i] * way);
    const PlateShares p =
        b.film.share > 0 ? absorbing_plate_of(face[i], a) : absorbing_plate(c, b.eta, a);
    s.reflected[i] = b.glass_reflect[i] * p.reflected;
    s.transmitted[i] =
        b.glass_transmit[i] * (p.transmitted + (1 - b.glass_scale) * a * p.reflected);
  }
  return s;
}

// Returns the reflectance of opaque gloss, of which the film replaces its share.
inline Rgb schlick_or_film(const Bsdf& b, float c) {
  const Rgb plain = fresnel_schlick(c, b.f0, b.f90);
  if (!(b.film.share > 0)) return plain;
  Rgb filmed{0};
  if (b.film.metal > 0) filmed += film_reflectance(b.film, b.film.metal_f0, c) * b.film.metal;
  if (b.film.coat > 0) filmed += film_reflectance(b.film, b.film.coat_f0, c) * b.film.coat;
  return plain + (filmed - plain) * b.film.share;
}

inline Split split_at(const Bsdf& b, float c) {
  switch (b.fresnel) {
    case Bsdf::Fresnel::none:
      break;
    case Bsdf::Fresnel::conductor:
      return {fresnel_conductor(c, b.f0, b.f90) * b.reflected_share, Rgb{0}};
    case Bsdf::Fresnel::schlick:
      return {schlick_or_film(b, c), Rgb{0}};
    case Bsdf::Fresnel::coat:
      return {fresnel_dielectric(c, b.eta) * b.reflected_share, Rgb{0}};
    case Bsdf::Fresnel::glass: {
      const Rgb opaque = schlick_or_film(b, c);
      const float plain = fresnel_dielectric(c, b.eta);
      if (plain >= 1) return {opaque + b.glass_weight * b.reflected_share, Rgb{0}};
      if (b.is_thin && !b.absorbed.is_black()) {
        const Split s = absorbing_sheet(b, c);
        return {opaque + s.reflected, s.transmitted};
      }
      Rgb r{b.is_thin ? plate_reflectance(c, b.eta) : plain};
      if (b.film.share > 0) {
        r = glass_or_film(b, c, plain);
        if (b.is_thin) r = r * 2 / (r + Rgb{1});  // film on both sides
      }
      return {opaque + b.glass_reflect * r, b.glass_transmit * (Rgb{1} - r * b.glass_scale)};
    }
  }
  return {};
}

}  // namespace troffer
