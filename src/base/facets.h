// Single scattering by microfacets with uncorrelated shadowing and masking: the product of Smith's
// G1 for both directions. Light lost between microfacets stays lost.
//
// This is the definition of Mitsuba's rough bsdfs. Importers and bsdf/ share these functions, so
// that a colour that an importer converts matches the reflection function that shows it.
//
// References: [1] Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR
//   2007. [2] W. Jakob et al., "Mitsuba 3 documentation: BSDFs" (roughplastic).
#pragma once

#include <cmath>
#include <cstdint>

namespace troffer {

enum class FacetShape : uint8_t { ggx, beckmann };

// Smith's G1, the share of microfacets that a direction sees, as a function of (alpha tan θ)². [1]
// Eq. 34; for Beckmann the rational fit of Eq. 27.
inline float smith_g1(FacetShape shape, float alpha_tan2) {
  if (shape == FacetShape::ggx) return 2 / (1 + std::sqrt(1 + alpha_tan2));
  if (!(alpha_tan2 > 0.390625f)) return 1;  // 1 / 1.6²
  const float a = 1 / std::sqrt(alpha_tan2);
  return (3.535f * a + 2.181f * a * a) / (1 + 2.276f * a + 2.577f * a * a);
}

// Shares of light from one direction that a rough dielectric boundary reflects and transmits.
struct RoughShares {
  double reflected = 0, through = 0;
};
// Computes both shares. `index` is the far side's index over the light's side's.
RoughShares rough_shares(FacetShape shape, double alpha, double index, double cosine);

// Mean reflectance of the boundary from inside for diffuse light: the sum of [2] over 64 cosines
// from 0 to 1. `index` is inside over outside.
float mean_rough_reflectance_inside(FacetShape shape, double alpha, double index);

}  // namespace troffer
