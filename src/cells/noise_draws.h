// What cells are off by, as draws: all of them of the same cells, each with signs of its own.
#pragma once

#include <array>
#include <cstddef>

namespace troffer {

// So many draws tell what light that many cells bring varies by, as well as so many measurements
// would; where one cell brings nearly all, they are one measurement, for what it is off by is known
// by one difference of halves.
constexpr int draws_of_noise = 16;

// Luminance of irradiance, or of sums of it: linear in light, so that draws of a sum are the sums
// of its terms' draws.
using NoiseDraws = std::array<float, draws_of_noise>;

inline void add_draws(NoiseDraws& to, float times, const NoiseDraws& what) {
  for (size_t k = 0; k < to.size(); ++k) to[k] += times * what[k];
}

}  // namespace troffer
