// Importance sampling of directions by a luminance image over the sphere, for sky_light.h and
// environment_light.h. Densities are per steradian.
//
// The luminance is bilinear between texel centres, as in image lookups. So radiance / density is
// the same for all samples, up to colour and, for lat_long, up to the sine within a row. Cells lie
// between the centres of four texels; cells at the square's edges are half as wide. A row, a cell
// in it and a place in the cell are chosen one after the other by inversion.
#pragma once

#include <cstdint>
#include <vector>

#include "base/sphere_map.h"
#include "base/vec.h"

namespace troffer {

class DirectionTable {
 public:
  // luminances: width × height texels, row 0 at v = 0; finite and not negative.
  DirectionTable(SphereMap map, int width, int height, const std::vector<float>& luminances);

  // Integral of the luminance over all directions. If it is 0, sample(), pdf() and square_of() must
  // not be called.
  double integral() const { return integral_; }

  // Returns a unit direction in the image's own axes for u in [0,1)². pdf: its density per
  // steradian, > 0.
  Vec3 sample(const Vec2& u, float& pdf) const;
  // Density per steradian of the unit direction w.
  float pdf(const Vec3& w) const;
  // Returns the u for which sample() returns w. Meaningful where pdf(w) > 0.
  Vec2 square_of(const Vec3& w) const;

 private:
  struct Cell {
    int x, y;
    Vec2 place;  // within the cell, [0,1]²
  };
  struct Corners {
    float at00, at10, at01, at11;  // first digit x, second y
  };
  Cell cell_at(const Vec2& uv) const;
  Corners corners(const Cell& c) const;
  float pdf_at(const Cell& c, const Vec2& uv) const;
  size_t columns() const { return size_t(width_) + 1; }  // number of cells
  size_t rows() const { return size_t(height_) + 1; }
  const float* row_cdf(int y) const { return cdf_x_.data() + size_t(y) * (columns() + 1); }

  SphereMap map_;
  int width_, height_;
  double integral_ = 0;
  std::vector<float> nodes_;          // (width + 2) × (height + 2)
  std::vector<float> row_factors_;    // mean steradians per area over each row of cells
  std::vector<float> cdf_y_, cdf_x_;  // from 0 to 1: over rows, and over the cells of each row
  std::vector<uint32_t> guide_y_, guide_x_;  // where searches in them begin
};

}  // namespace troffer
