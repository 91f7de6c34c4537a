// Draws points of a source from the open samples of a coverage mask. Rays and integrands use them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shadow/coverage_mask.h"

namespace troffer {

// Open samples of one receiver and cell, with their weights.
struct OpenSamples {
  MaskRows rows;
  MaskWeights weights;
  Vec2 shift;
  float open_by_row[most_mask_rows];
  float open = 0;  // sum of open_by_row
};

// Appends n points in world space, drawn from the open samples in proportion to weight. The open
// weight is divided along the rows into n equal parts, and each part gives one point by its own
// hash of `random`. The mean of any 0/1 function therefore has a variance of at most 1/4n. Fewer
// points are appended only if no sample is open.
void draw_points(const MaskFrame& frame, const OpenSamples& samples, uint32_t n, uint64_t random,
                 std::vector<Vec3>& points);

// Does the same along a Hilbert curve through the samples. Each point then stands for a compact
// part of the source, which matters for many points. Slower than draw_points.
void draw_points_compact(const MaskFrame& frame, const OpenSamples& samples, uint32_t n,
                         uint64_t random, std::vector<Vec3>& points);

}  // namespace troffer
