// How many viewing rays a pixel wants, by what they differ by, and how much is done for each.
#pragma once

#include <cstdint>

namespace troffer {

// Variances of a sample's luminance, for what is seen to vary around its pixel.
struct SampleSpread {
  double chance = 0;  // by random numbers of its own
  double placed = 0;  // by where it lies in a pixel that an edge divides
  double thin = 0;    // … if things are too thin for samples spread over the pixel to tell evenly
  double clutter = 0;  // what the neighbours' samples may have missed
};

struct SampleNeed {
  double count = 0;
  uint32_t effort_divisor = 1;  // SampleRequest::effort_divisor
};

struct SampleCosts {
  double first = 0;  // samples that the pixel has: of so few no further one is asked for
  double most = 0;   // … that it may have: thrift that would want more is not for it
  // Count × cost beyond this squared is in proportion to the standard deviation, not to the
  // variance. 0: never.
  double most_even = 0;
  double evenness = 0;               // PixelSampling
  uint32_t most_effort_divisor = 1;  // 1: further samples are drawn as the first ones are
};

// With what thrift samples leave the pixel an error of `allowed` (both in luminance; mean: of what
// is around) for the least time, and how many of them.
SampleNeed least_work(const SampleSpread& spread, double mean, double allowed,
                      const SampleCosts& costs);

}  // namespace troffer
