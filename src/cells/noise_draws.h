// Draws of the error of light that comes from cells. All draws are of the same cells, each with
// random signs of its own.
#pragma once

#include <array>
#include <cstddef>

namespace troffer {

// Number of draws. For light of many cells they give its variance as well as this many measurements
// would. Where one cell brings nearly all, they are one measurement, because one difference of
// halves is all that is known of its error.
constexpr int draws_of_noise = 16;

// Luminance of irradiance, or of sums of it. Linear in light: draws of a sum are the sums of its
// terms' draws.
using NoiseDraws = std::array<float, draws_of_noise>;

inline void add_draws(NoiseDraws& to, float times, const NoiseDraws& what) {
  for (size_t k = 0; k < to.size(); ++k) to[k] += times * what[k];
}

}  // namespace troffer
