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

// Appends n points in world space, drawn from the open samples in proportion to weight, by
// systematic sampling along the rows with one random start in [0,1): sample i is drawn n weight /
// open times on average. Fewer than n only where rounding has used the weights up.
void draw_points(const MaskFrame& frame, const OpenSamples& samples, uint32_t n, float start,
                 std::vector<Vec3>& points);

// The same along a Hilbert curve through the samples instead of their rows: neighbours in the order
// are neighbours on the source, and each point stands for a compact part of it. Slower to draw.
void draw_points_compact(const MaskFrame& frame, const OpenSamples& samples, uint32_t n,
                         float start, std::vector<Vec3>& points);

}  // namespace troffer
