// How one microfacet of a Bsdf's glossy lobe divides the light that meets it.
#pragma once

#include <algorithm>
#include <cmath>

#include "bsdf/bsdf.h"
#include "bsdf/fresnel.h"

namespace troffer {

// What a microfacet reflects and transmits at a cosine of incidence on it.
struct Split {
  Rgb reflected, transmitted;
  // Probability of following the reflection.
  float reflection_share() const {
    const float r = average(reflected), t = average(transmitted);
    return t > 0 ? r / (r + t) : 1.0f;
  }
};

// Through an absorbing sheet the way is longer the more it leans. Where reflection is scaled, what
// is not reflected goes through.
inline Split absorbing_sheet(const Bsdf& b, float c) {
  const float way = 1 / std::max(refracted_cosine(c, b.eta), 1e-4f);
  Split s;
  for (size_t i = 0; i < 3; ++i) {
    const float a = std::exp(-b.absorbed[i] * way);
    const PlateShares p = absorbing_plate(c, b.eta, a);
    s.reflected[i] = b.glass_reflect[i] * p.reflected;
    s.transmitted[i] =
        b.glass_transmit[i] * (p.transmitted + (1 - b.glass_scale) * a * p.reflected);
  }
  return s;
}

inline Split split_at(const Bsdf& b, float c) {
  switch (b.fresnel) {
    case Bsdf::Fresnel::none:
      break;
    case Bsdf::Fresnel::conductor:
      return {fresnel_conductor(c, b.f0, b.f90), Rgb{0}};
    case Bsdf::Fresnel::schlick:
      return {fresnel_schlick(c, b.f0, b.f90), Rgb{0}};
    case Bsdf::Fresnel::coat:
      return {Rgb{fresnel_dielectric(c, b.eta)}, Rgb{0}};
    case Bsdf::Fresnel::glass: {
      const Rgb opaque = fresnel_schlick(c, b.f0, b.f90);
      float r = fresnel_dielectric(c, b.eta);
      if (r >= 1) return {opaque + Rgb{b.glass_weight}, Rgb{0}};
      if (b.is_thin && !b.absorbed.is_black()) {
        const Split s = absorbing_sheet(b, c);
        return {opaque + s.reflected, s.transmitted};
      }
      if (b.is_thin) r = plate_reflectance(c, b.eta);
      return {opaque + b.glass_reflect * r, b.glass_transmit * (1 - b.glass_scale * r)};
    }
  }
  return {};
}

}  // namespace troffer
