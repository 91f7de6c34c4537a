// What a smooth dielectric boundary does to light that a diffuse base under it scatters.
//
// References: [1] L. B. Wolff, "Diffuse-Reflectance Model for Smooth Dielectric Surfaces", JOSA A
//   11(11), 1994.
#pragma once

namespace troffer {

// Mean reflectance of the boundary from inside, over diffuse light: what of the base's light comes
// back to it [1]. `index`: inside over outside, above 0. Exact Fresnel terms, midpoint rule.
float mean_reflectance_inside(double index);

// A base of reflectance ρ under a coat whose mean reflectance from inside is f, and the reflectance
// of a base that looks the same where every reflection within is as of a white one: ρ (1-f) /
// (1-ρf), and back.
constexpr float as_of_white_base(float rho, float f) {
  return rho * (1 - f) / (1 - rho * f);
}
constexpr float from_white_base(float rho, float f) {
  return rho / (1 - f + rho * f);
}

}  // namespace troffer
