// Reflection of diffuse light at a smooth dielectric boundary from inside. Importers and bsdf/ use
// it for coats over a diffuse base, so that both have the same brightness.
//
// References: [1] L. B. Wolff, "Diffuse-Reflectance Model for Smooth Dielectric Surfaces", JOSA A
//   11(11), 1994.
#pragma once

namespace troffer {

// Mean reflectance of the boundary from inside for diffuse light: the share of the base's light
// that returns to it [1]. `index` is inside over outside, above 0. Exact Fresnel terms, midpoint
// rule.
float mean_reflectance_inside(double index);

// Convert the reflectance ρ of a base under a coat of mean inside reflectance f. to_white_base()
// returns the equivalent reflectance for a coat that treats every inner reflection as if the base
// were white: ρ (1-f) / (1-ρf). from_white_base() is its inverse.
constexpr float to_white_base(float rho, float f) {
  return rho * (1 - f) / (1 - rho * f);
}
constexpr float from_white_base(float rho, float f) {
  return rho / (1 - f + rho * f);
}

}  // namespace troffer
