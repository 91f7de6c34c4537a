// Environment light by shadow rays alone, for hits where proofs do not pay: few scattered hits, or
// a mostly open sky. EnvironmentSampler (environment_sampler.h) samples the sky, images and every
// sun.
//
// Pilot rays of the batch (environment_pilots.h) decide how many samples a hit gets. The number of
// sky samples also depends on the light that arrived from suns: where that is large, the sky
// contributes little of the error. Suns come first and use random numbers of their own, so the
// estimate is unbiased.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "certified/environment_pilots.h"

namespace troffer {

// Samples whose shadow rays are pending: scratch memory of one thread.
struct EnvironmentRays {
  struct Term {
    Rgb light;            // unoccluded contribution
    int32_t ray = -1;     // index in `rays`; -1: no contribution
    uint32_t member = 0;  // index in the cluster
  };
  std::vector<Term> terms;
  std::vector<size_t> runs;  // start of each pixel in `terms`
  std::vector<Ray> rays;
  std::vector<uint8_t> is_occluded;
  PaneFactors factors;
  // Per member of the cluster.
  std::vector<float> arrived;     // light of suns and other sources, luminance × sr
  std::vector<uint32_t> numbers;  // largest number of sky samples
  // Samples of one pixel, and the same sorted by part.
  std::vector<EnvironmentSampler::Choice> choices, sorted;
  std::vector<uint32_t> of_choice, of_sorted;  // cluster member of each sample
  std::vector<uint32_t> first;                 // per part: start in `sorted`
  std::vector<EnvironmentSampler::Point> points;
  std::vector<Rgb> radiance;
  // Random numbers of one hit.
  std::vector<uint64_t> streams;
  std::vector<uint32_t> samples;
  std::vector<float> uniform;
  EnvironmentSampler::Chances chances;
};

// Adds the light of all environment lights at each of `members`. The number of samples is chosen
// for the budget's error relative to the light that arrives, as `share` predicts it. seen: per
// member, luminance × sr received from other sources; empty: none.
void cast_environment_rays(const EnvironmentSamplerInputs& draws, std::span<const uint32_t> members,
                           const EnvironmentShare& share, std::span<const float> seen,
                           const DrawingBudget& budget, EnvironmentRays& memory, RadianceBatch& out,
                           Counters& counters);

}  // namespace troffer
