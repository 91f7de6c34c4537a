// What points that gather light from cells err by, and how many rays of cells that is worth.
//
// A point's error is that of its own gather rays, which is brought down to what is asked, and that
// of the cells, which no number of gather rays brings down. Rays of cells serve all points, so that
// many points are worth many: docs/measure.md, "Rays for points".
#pragma once

#include <span>
#include <vector>

#include "cells/cell_rows.h"

namespace troffer {

// How points gather.
struct GatheringPoints {
  double rays = 0, most_rays = 0;  // of each point: these, or as many as bring it to …
  double error = 0;                // … this, of all its light; 0: so many rays do
  double other_rays = 0;           // that are asked for anyway, of all points: an audit's
};

// What one ray of a point saw.
struct PointRay {
  uint32_t cell = 0;
  float weight = 0;  // luminance of what it brings, over that of the cell's irradiance
};

// What each point's first rays have seen: of each point two sets of rays, which have nothing to do
// with each other, however the rays of either are spread.
struct PointsSeen {
  static constexpr uint32_t sets = 2;

  uint32_t rays = 0;           // of each set
  std::vector<PointRay> seen;  // of one set after the other, less those that saw nothing …
  std::vector<size_t> end;     // … up to here
};

// What each cell by itself is off by, as one draw: luminance.
struct CellsOff {
  std::vector<float> by_rows;  // by the choice of its rays; partly by that of hits they leave from
  std::vector<float> by_hits;  // by the choice of hits at which it is lit
};

// Variances, means over points, each by the mean of one over the squares of all light that the
// point gets and of the list's mean.
struct PointsNoise {
  double by_rows = 0, by_hits = 0;  // as CellsOff has it
  double by_gather = 0;             // by gather rays …
  double gather_rays = 0;           // … of all points
  double other_rays = 0;            // GatheringPoints::other_rays
};

// direct: luminance of irradiance straight from sources at each point, by which it is known how
// much its other light matters; light: of cells. Gather rays are taken to be independent and drawn
// by the cosine; those that are aimed and spread evenly are fewer, or err by less.
PointsNoise noise_at_points(const PointsSeen& points, const std::vector<float>& direct,
                            const CellRows& rows, const std::vector<Rgb>& light,
                            const CellsOff& off, const GatheringPoints& how, int threads);

// How many times as many rays cells are worth as they have, where that is more: 1 or more. A ray of
// a cell and one of a point take as long; the time for all is to be least for the same error. With
// G rays of points, others included, V of the variance by the R rays of rows, and U of it by all
// else, time times variance, (G + R') (U + V R / R'), is least for R'² = G V R / U.
double times_as_many_rays(const PointsNoise& noise, double rays_of_rows);

}  // namespace troffer
