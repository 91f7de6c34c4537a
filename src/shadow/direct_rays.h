// Direct rays to a flat source whose facet lists are over budget. They are stratified, and their
// number follows from the asked error. Points come from one Owen-scrambled Sobol sequence over all
// viewing rays of a pixel. On rectangles they are uniform in solid angle. Otherwise they are spread
// over cells in proportion to exact unoccluded light, and uniformly by area within a cell.
// Estimator: let f be the unoccluded term over the points' density, V the visibility and U the
// exact unoccluded light. The mean of f V - b (f - U) is unbiased for any b that does not depend on
// the points. b = 1 leaves no noise where nothing hides the source, b = 0 where all of it is
// hidden. Pilot samples (pilot_rays.h) choose b.
#pragma once

#include <cstdint>
#include <vector>

#include "base/random.h"
#include "light/light_points.h"
#include "shadow/gather_facets.h"
#include "shadow/ray_spread.h"

namespace troffer {

// Working memory of cast_direct_rays.
struct DirectRayMemory {
  std::vector<FlatCell> cells;
  std::vector<float> unoccluded;  // per cell and receiver, sr
  std::vector<float> values;      // those of a cell per receiver, or of one receiver's rays
  SobolBlocks blocks;
  std::vector<float> block, numbers;
  LightPoints points;
  std::vector<float> weights;  // per ray, receiver by receiver: f, sr
  SegmentArrays segments;
  std::vector<float> ends;  // per receiver: share of the way that rays go
  std::vector<uint8_t> is_hidden;
  std::vector<ShadowSegment> rest;
  std::vector<uint32_t> rest_of;
  std::vector<ShadowHit> hits;
  struct Answer {
    uint32_t member;
    float unoccluded, share;  // sr, and its visible share
  };
  std::vector<Answer> answers;
  RaySpread spread;
};

// Fewest rays per receiver.
constexpr double fewest_rays = 16;

// Returns the number of rays of each receiver of a batch. It meets the masks' error limit (Promise)
// for a half-open source, in proportion to its share of the unoccluded light. A weak source gets at
// least what its own visible share deserves (RayLimits::pair_error). The number does not depend on
// the open share: bright batches, which count more, would get fewer rays than dark ones. The first
// call for a source casts pilot rays, which find its open share.
double direct_rays_of(const SourceTask& task, ShadowScene& scene);

// Adds the answers of `members` of the part to `results`.
void cast_direct_rays(const SourceTask& task, const SourcePart& part,
                      std::span<const uint32_t> members, ShadowScene& scene,
                      DirectRayMemory& memory, SourceResults& results);

}  // namespace troffer
