// Where so many facets stand before a flat source that no list is worth its while: rays straight to
// the source, as many as the asked error takes, and nothing else that costs time.
//
// Points come from one Owen-scrambled Sobol sequence over all viewing rays of a pixel: of
// rectangles evenly by solid angle, else spread over the source's cells in proportion to their
// exact unoccluded light, and evenly over each. With f the unoccluded term over the points'
// density, V what a ray says and b any number that does not depend on them, the mean of f V - b (f
// - U) is unbiased, U being the exact unoccluded light: where nothing hides the source b = 1 leaves
// no noise, and where all does b = 0. What b is comes from pilots (pilot_rays.h).
#pragma once

#include <cstdint>
#include <vector>

#include "base/random.h"
#include "light/light_points.h"
#include "shadow/gather_facets.h"
#include "shadow/ray_spread.h"

namespace troffer {

struct DirectRayMemory {
  std::vector<FlatCell> cells;
  std::vector<float> unoccluded;  // per cell and receiver, sr
  std::vector<float> values;      // of a cell, or of a receiver's rays
  SobolBlocks blocks;
  std::vector<float> block, numbers;
  LightPoints points;
  std::vector<float> weights;  // receiver by receiver: f, sr
  SegmentArrays segments;
  std::vector<float> ends;  // per receiver: how much of the way rays go
  std::vector<uint8_t> is_hidden;
  std::vector<ShadowSegment> rest;
  std::vector<uint32_t> rest_of;
  std::vector<ShadowHit> hits;
  struct Answer {
    uint32_t member;
    float unoccluded, share;  // sr, and what of it arrives
  };
  std::vector<Answer> answers;
  RaySpread spread;
};

constexpr double fewest_rays = 16;

// So many rays from each receiver of a batch: as many as make the error what the masks' may be
// (Promise) where the source is half open, by its share of the unoccluded light, and no fewer than
// a weak source's own visible share is worth (RayLimits::pair_error). Not by what is
// open here: batches in which little is would take rays from those in which much is, where they
// count for more of the picture's light; and a pixel's viewing rays share a sequence. The first
// cluster that asks has pilots cast, which find what is open.
double direct_rays_of(const SourceTask& task, ShadowScene& scene);

// Answers `members` of the part.
void cast_direct_rays(const SourceTask& task, const SourcePart& part,
                      std::span<const uint32_t> members, ShadowScene& scene,
                      DirectRayMemory& memory, SourceResults& results);

}  // namespace troffer
