// Random draws of the error that the noise of cells causes in light gathered from them. Each draw
// gives the error of every cell a random sign; a cell has the same sign wherever it is read.
#pragma once

#include <array>
#include <cstddef>

namespace troffer {

// Number of draws. For light from many cells, the variance of the draws is as accurate as that of
// this many repeated measurements. If nearly all light comes from one cell, all draws have the same
// size: a single difference between two halves of its samples is known.
constexpr int draws_of_noise = 16;

// Luminance of irradiance, or of sums of it. Linear in light: draws of a sum are the sums of its
// terms' draws.
using NoiseDraws = std::array<float, draws_of_noise>;

inline void add_draws(NoiseDraws& to, float times, const NoiseDraws& what) {
  for (size_t k = 0; k < to.size(); ++k) to[k] += times * what[k];
}

}  // namespace troffer
