// Points of a source drawn from a coverage mask's open samples.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shadow/coverage_mask.h"

namespace troffer {

// Open samples of one receiver to one cell, and their weights: what is needed to draw from them.
struct OpenSamples {
  MaskRows rows;
  MaskWeights weights;
  Vec2 shift;
  float open_by_row[most_mask_rows];
  float open = 0;  // the sum of open_by_row
};

// Appends n points in world space, drawn from the open samples in proportion to weight: of n equal
// parts of the open weight, along the rows, one point from each, by numbers of its own hashed from
// `random`. Of any 0 or 1 of the samples the variance of the mean is therefore at most 1/4n. Fewer
// than n only where there is no open sample.
void draw_points(const MaskFrame& frame, const OpenSamples& samples, uint32_t n, uint64_t random,
                 std::vector<Vec3>& points);

// The same along a Hilbert curve through the samples instead of their rows: neighbours in the order
// are neighbours on the source, and each point stands for a compact part of it. Slower to draw.
void draw_points_compact(const MaskFrame& frame, const OpenSamples& samples, uint32_t n,
                         uint64_t random, std::vector<Vec3>& points);

}  // namespace troffer
