// Directions drawn in proportion to a luminance that is known on an image over the sphere.
//
// The luminance is bilinear between the texels' centres, as the image itself is when it is looked
// up, so that radiance over density is the same for all samples up to colour and, for lat_long, to
// the sine within a row. Cells lie between the centres of four texels (at the square's edges, half
// of one); a row, a cell within it and a place within the cell are chosen one after the other, all
// by inversion.
#pragma once

#include <cstdint>
#include <vector>

#include "base/sphere_map.h"
#include "base/vec.h"

namespace troffer {

class DirectionTable {
 public:
  // Luminances of width × height texels, row 0 at v = 0: finite, not negative.
  DirectionTable(SphereMap map, int width, int height, const std::vector<float>& luminances);

  // Integral of the luminance over all directions; 0: there is nothing to sample.
  double integral() const { return integral_; }

  // A direction in the image's own axes, for u in [0,1)², and its density per steradian, > 0.
  // Nothing may be asked where integral() is 0.
  Vec3 sample(const Vec2& u, float& pdf) const;
  // Density per steradian of a unit direction.
  float pdf(const Vec3& w) const;
  // The u for which sample() returns w; meaningful where pdf(w) > 0.
  Vec2 square_of(const Vec3& w) const;

 private:
  struct Cell {
    int x, y;
    Vec2 place;  // within it, [0,1]²
  };
  struct Corners {
    float at00, at10, at01, at11;  // first x, then y
  };
  Cell cell_at(const Vec2& uv) const;
  Corners corners(const Cell& c) const;
  float pdf_at(const Cell& c, const Vec2& uv) const;
  size_t columns() const { return size_t(width_) + 1; }  // of cells
  size_t rows() const { return size_t(height_) + 1; }
  const float* row_cdf(int y) const { return cdf_x_.data() + size_t(y) * (columns() + 1); }

  SphereMap map_;
  int width_, height_;
  double integral_ = 0;
  std::vector<float> nodes_;          // (width + 2) × (height + 2)
  std::vector<float> row_factors_;    // mean steradians per area over each row of cells
  std::vector<float> cdf_y_, cdf_x_;  // from 0 to 1, over rows; over the cells of each row
};

}  // namespace troffer
