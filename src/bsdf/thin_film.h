// Interference in a thin film over a smooth base: its reflectance by angle, as colours.
//
// For each polarisation, with amplitudes r12 at the film and r23 at the base below it (real: the
// base has a real index) and q = r12 r23, Airy's sum over all ways to and fro [1, §7.6] is
//   R = 1 - (1 - r12²) (1 - r23²) / (1 + q² + 2 q cos δ),  δ = 2π D / λ,  D = 2 n d cos θ
// and 1 / (1 + q² + 2 q cos δ) = (1 + 2 Σ (-q)^m cos m δ) / (1 - q²), so that a colour needs only
// the mean of cos(2π m D / λ) over what a channel sees of the spectrum: a table over D. Belcour &
// Barla [2] do the same with Gaussian curves in place of the table.
//
// References: [1] Born & Wolf, "Principles of Optics", 7th ed. [2] Belcour & Barla, "A Practical
//   Extension to Microfacet Theory for the Modeling of Varying Iridescence", TOG 36(4), 2017.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/rgb.h"
#include "bsdf/fresnel.h"

namespace troffer {

// Mean of cos(2π D / λ) over a channel's part of an equal-energy spectrum, relative to white, by
// the path difference D: 1 at 0, and nothing where D is so long that colours even out.
struct InterferenceTable {
  static constexpr float step_nm = 4;
  static constexpr size_t count = 2500;  // 10 µm
  std::vector<Rgb> values;

  Rgb at(float difference_nm) const {
    const float x = difference_nm / step_nm;
    const auto i = size_t(x);
    if (!(x < float(count - 1))) return Rgb{0};
    return values[i] + (values[i + 1] - values[i]) * (x - float(i));
  }
};
InterferenceTable make_interference_table();

struct ThinFilm {
  float share = 0;  // of the surface that wears it; 0: there is none
  float ior = 1.3f, thickness_nm = 0;
  const InterferenceTable* table = nullptr;
  // Reflectances at normal incidence of what it lies over, and how much of the surface each is.
  Rgb metal_f0, coat_f0;
  float metal = 0, coat = 0;
};

// The index of a base that reflects f0 straight on, seen from air.
inline float index_from_reflectance(float f0) {
  const float root = std::sqrt(std::clamp(f0, 0.0f, 0.9999f));
  return (1 + root) / (1 - root);
}

// Reflectance of the film over a base of normal reflectance f0, from outside at a cosine.
Rgb film_reflectance(const ThinFilm& film, Rgb f0, float cosine);

}  // namespace troffer
