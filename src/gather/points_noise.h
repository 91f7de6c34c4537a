// Estimates the noise of measuring points that gather light from cells, and from it the number of
// rays that cells should get. Used by cell_builder.cpp.
//
// A point's error has two parts. Gather rays bring their own part down to the asked error. The part
// of the cells does not depend on them. Rays of cells serve all points, so more of them pay off
// where there are more points: docs/method/measuring.md, "Rays for points".
#pragma once

#include <span>
#include <vector>

#include "cells/cell_rows.h"

namespace troffer {

// Gather rays of measuring points. Each point gets `rays`, or up to `most_rays` until the relative
// error of all its light is `error`. Error 0: `rays` suffice.
struct GatheringPoints {
  double rays = 0, most_rays = 0;  // planned and largest number for each point
  double error = 0;
  double other_rays = 0;  // rays for all points together that are traced anyway (an audit)
};

// The cell that one ray of a point saw.
struct PointRay {
  uint32_t cell = 0;
  float weight = 0;  // luminance of what it brings, over that of the cell's irradiance
};

// Cells that the points' first rays have seen: of each point, two independent sets of stratified
// rays.
struct PointsSeen {
  static constexpr uint32_t sets = 2;

  uint32_t rays = 0;           // per set
  std::vector<PointRay> seen;  // one set after the other, without rays that saw nothing
  std::vector<size_t> end;     // end of each set in `seen`
};

// One draw of the error of each cell by itself: luminance.
struct CellErrors {
  // by the choice of its rays and, partly, of the hits where they start
  std::vector<float> by_rows;
  std::vector<float> by_hits;  // by the choice of hits at which direct light is computed
};

// Relative variances, averaged over points. A point's variance is multiplied by the mean of two
// numbers: 1 / light² for all light of the point, and 1 / light² for the mean light of the list.
struct PointsNoise {
  double by_rows = 0, by_hits = 0;  // by the errors of CellErrors
  double by_gather = 0;             // by gather rays
  double gather_rays = 0;           // number of gather rays of all points
  double other_rays = 0;            // GatheringPoints::other_rays
};

// Estimates the noise of all points. direct: luminance of direct irradiance at each point, which
// says how much its other light matters. light: irradiance of cells. Assumes independent,
// cosine-distributed gather rays; guided and stratified ones are fewer or err less.
PointsNoise noise_at_points(const PointsSeen& points, const std::vector<float>& direct,
                            const CellRows& rows, const std::vector<Rgb>& light,
                            const CellErrors& off, const GatheringPoints& how, uint64_t seed,
                            int threads);

// Returns the factor on the number of rays of cells, at least 1, that minimises the time for a
// given error. A ray of a cell costs as much as one of a point. Let G be the number of all other
// rays, R that of the rays of cells, V the variance that these cause, and U all other variance.
// With R' rays of cells, time times variance is (G + R') (U + V R / R'), which is least for R'² = G
// V R / U.
double times_as_many_rays(const PointsNoise& noise, double rays_of_rows);

}  // namespace troffer
