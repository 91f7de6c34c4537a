// Interference in a thin film over a smooth base: its reflectance in rgb by angle. Microfacets of
// Fresnel::schlick and Fresnel::glass use it (split.h).
//
// Let r12 and r23 be the amplitudes at the film and at the base below it, for one polarisation.
// They are real, because the base has a real index. With q = r12 r23, Airy's sum over all
// inter-reflections in the film [1, §7.6] is
//   R = 1 - (1 - r12²) (1 - r23²) / (1 + q² + 2 q cos δ),  δ = 2π D / λ,  D = 2 n d cos θ
// and 1 / (1 + q² + 2 q cos δ) = (1 + 2 Σ (-q)^m cos m δ) / (1 - q²). An rgb channel therefore
// needs only the mean of cos(2π m D / λ) over its part of the spectrum, which is tabulated over D.
// Belcour & Barla [2] use Gaussian curves instead of the table.
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
// the path difference D in nm. It is 1 at D = 0, and 0 beyond the table, where the colours average
// out.
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
  float share = 0;  // share of the surface that has the film; 0: no film
  float ior = 1.3f, thickness_nm = 0;
  const InterferenceTable* table = nullptr;
  // Normal reflectances of the metal and the coat below the film, and their shares of the surface.
  Rgb metal_f0, coat_f0;
  float metal = 0, coat = 0;
};

// Returns the index of a base with normal reflectance f0, seen from air.
inline float index_from_reflectance(float f0) {
  const float root = std::sqrt(std::clamp(f0, 0.0f, 0.9999f));
  return (1 + root) / (1 - root);
}

// Returns the film's reflectance over a base of normal reflectance f0, for a cosine outside.
Rgb film_reflectance(const ThinFilm& film, Rgb f0, float cosine);

}  // namespace troffer
