// Light from infinity by rays alone, for hits that proofs are not worth: few of them, scattered, or
// where most of the sky is open anyway. Points of the sky and of images, and of every sun, are
// chosen by far_points.h, and a ray asks for each.
//
// How many points a hit gets is decided by rays of its batch that count for nothing else, and for
// the sky also by what has arrived at the hit from suns: where that is much, little of the error is
// the sky's. Suns are asked first, by random numbers of their own: unbiased.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "certified/far_pilots.h"

namespace troffer {

// Points that wait for their rays: memory of one thread.
struct FarRays {
  struct Term {
    Rgb light;         // that arrives if nothing is in the way
    int32_t ray = -1;  // -1: none arrives
    uint32_t member = 0;
  };
  std::vector<Term> terms;
  std::vector<size_t> runs;  // where terms of another pixel begin
  std::vector<Ray> rays;
  std::vector<uint8_t> is_occluded;
  PaneFactors factors;
  // Per member of the cluster.
  std::vector<float> arrived;     // from suns and other sources, luminance × sr
  std::vector<uint32_t> numbers;  // points
  // Of a pixel, by the number of their parts.
  std::vector<FarPoints::Choice> choices, sorted;
  std::vector<uint32_t> of_choice, of_sorted;  // members
  std::vector<uint32_t> first;                 // per part
  std::vector<FarPoints::Point> points;
  std::vector<Rgb> radiance;
  // Of a hit.
  std::vector<uint64_t> streams;
  std::vector<uint32_t> samples;
  std::vector<float> uniform;
  FarPoints::Chances chances;
};

// Light of all far sources at each of `members`, with so many points that it errs by the budget's
// error of the light that arrives, if the share holds. seen: per member, luminance × sr of what
// other sources bring; empty: nothing.
void cast_far_rays(const FarPointDraws& draws, std::span<const uint32_t> members,
                   const FarShare& share, std::span<const float> seen, const DrawingBudget& budget,
                   FarRays& memory, RadianceBatch& out, Counters& counters);

}  // namespace troffer
