// Number of viewing rays that a pixel needs, and the sampling effort for each, from the variances
// seen around it. Used by refinement. Variances are of luminance.
#pragma once

#include <cstdint>

namespace troffer {

// Variance of one sample's luminance, by cause, estimated around the pixel.
struct SampleSpread {
  double chance = 0;   // independent of the position in the pixel
  double placed = 0;   // by position, in a pixel that an edge divides
  double thin = 0;     // by position, for features too small for stratification
  double clutter = 0;  // from features that the neighbours' samples may have missed
};

struct SampleNeed {
  double count = 0;
  uint32_t effort_divisor = 1;  // SampleRequest::effort_divisor
};

struct SampleCosts {
  double first = 0;  // samples that the pixel has; no fewer are considered
  double most = 0;   // samples that it may have; effort divisors that need more are excluded
  // If count × cost exceeds the square of this, it is reduced to the proportion of the standard
  // deviation instead of the variance. 0: never.
  double most_even = 0;
  double evenness = 0;               // PixelSampling
  uint32_t most_effort_divisor = 1;  // 1: further samples are computed like the first ones
};

// Returns the effort divisor and the number of samples with which a pixel reaches the error
// `allowed` at least cost. `allowed` and `mean`, the mean of the surroundings, are luminances.
SampleNeed least_work(const SampleSpread& spread, double mean, double allowed,
                      const SampleCosts& costs);

}  // namespace troffer
