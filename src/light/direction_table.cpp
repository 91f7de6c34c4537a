#include "light/direction_table.h"

#include <algorithm>

#include "light/guide_table.h"

namespace troffer {

namespace {

// Position of the i-th cell edge along an axis of n texels: 0, the texel centres, 1.
float edge(int i, int n) {
  return i <= 0 ? 0 : i > n ? 1 : (float(i) - 0.5f) / float(n);
}

// sample_line() returns t in [0,1] with density proportional to the line from a to b, which must
// not both be 0. invert_line() is its inverse.
float sample_line(float a, float b, float u) {
  const float root = std::sqrt(lerp(a * a, b * b, u));
  const float t = u * (a + b) / (a + root);
  return a + root > 0 ? std::min(t, 1.0f) : 0;
}
float invert_line(float a, float b, float t) {
  return t * (2 * a + (b - a) * t) / (a + b);
}

}  // namespace

DirectionTable::DirectionTable(SphereMap map, int width, int height,
                               const std::vector<float>& luminances)
    : map_(map), width_(width), height_(height) {
  const size_t stride = columns() + 1;
  nodes_.resize(stride * (rows() + 1));
  const auto texel = [&](int x, int y) {
    return luminances[texel_on_sphere(map, width, height, x, y)];
  };
  for (int j = 0; j <= height + 1; ++j)
    for (int i = 0; i <= width + 1; ++i) {
      // A node on the square's edge lies midway between texels on both sides of it.
      const int x0 = i == 0 ? -1 : i - 1, x1 = i == 0 ? 0 : i == width + 1 ? width : i - 1;
      const int y0 = j == 0 ? -1 : j - 1, y1 = j == 0 ? 0 : j == height + 1 ? height : j - 1;
      const int xa = i == width + 1 ? width - 1 : x0, ya = j == height + 1 ? height - 1 : y0;
      nodes_[size_t(j) * stride + size_t(i)] =
          0.25f * ((texel(xa, ya) + texel(x1, ya)) + (texel(xa, y1) + texel(x1, y1)));
    }

  row_factors_.resize(rows());
  cdf_y_.resize(rows() + 1);
  cdf_x_.resize(rows() * stride);
  guide_y_.resize(rows());
  guide_x_.resize(rows() * columns());
  std::vector<double> of_row(rows()), of_cell(columns());
  for (int y = 0; y <= height; ++y) {
    const double v0 = double(edge(y, height)), v1 = double(edge(y + 1, height));
    const double steradians = map == SphereMap::lat_long
                                  ? 2 * pi * (std::cos(pi * v0) - std::cos(pi * v1))
                                  : 4 * pi * (v1 - v0);
    row_factors_[size_t(y)] = float(steradians / (v1 - v0));
    for (int x = 0; x <= width; ++x) {
      const Corners c = corners({x, y, {}});
      const double mean =
          0.25 * ((double(c.at00) + double(c.at10)) + (double(c.at01) + double(c.at11)));
      of_cell[size_t(x)] = mean * double(edge(x + 1, width) - edge(x, width));
    }
    of_row[size_t(y)] = fill_cdf(of_cell, cdf_x_.data() + size_t(y) * stride) * steradians;
    fill_guide(row_cdf(y), columns(), guide_x_.data() + size_t(y) * columns());
  }
  integral_ = fill_cdf(of_row, cdf_y_.data());
  fill_guide(cdf_y_.data(), rows(), guide_y_.data());
}

DirectionTable::Corners DirectionTable::corners(const Cell& c) const {
  const float* below = nodes_.data() + size_t(c.y) * (columns() + 1) + size_t(c.x);
  const float* above = below + columns() + 1;
  return {below[0], below[1], above[0], above[1]};
}

DirectionTable::Cell DirectionTable::cell_at(const Vec2& uv) const {
  Cell c;
  const auto along = [](float u, int n, int& i) {
    i = std::clamp(int(u * float(n) + 0.5f), 0, n);
    const float from = edge(i, n), to = edge(i + 1, n);
    return std::clamp((u - from) / (to - from), 0.0f, 1.0f);
  };
  c.place.x = along(uv.x, width_, c.x);
  c.place.y = along(uv.y, height_, c.y);
  return c;
}

// Luminance divided by its integral, per unit of the square's area, then per steradian.
float DirectionTable::pdf_at(const Cell& c, const Vec2& uv) const {
  const Corners n = corners(c);
  const float luminance =
      lerp(lerp(n.at00, n.at10, c.place.x), lerp(n.at01, n.at11, c.place.x), c.place.y);
  // The pole has no area, so any finite density will do.
  const float steradians = std::max(solid_angle_per_area(map_, uv.y), 1e-6f);
  return float(double(luminance) * double(row_factors_[size_t(c.y)]) /
               (double(steradians) * integral_));
}

Vec3 DirectionTable::sample(const Vec2& u, float& pdf) const {
  Cell c;
  float along_y = u.y, along_x = u.x;
  c.y = choose_step(cdf_y_.data(), guide_y_.data(), rows(), along_y);
  c.x = choose_step(row_cdf(c.y), guide_x_.data() + size_t(c.y) * columns(), columns(), along_x);
  const Corners n = corners(c);
  c.place.y = sample_line(n.at00 + n.at10, n.at01 + n.at11, along_y);
  c.place.x =
      sample_line(lerp(n.at00, n.at01, c.place.y), lerp(n.at10, n.at11, c.place.y), along_x);
  const Vec2 uv{lerp(edge(c.x, width_), edge(c.x + 1, width_), c.place.x),
                lerp(edge(c.y, height_), edge(c.y + 1, height_), c.place.y)};
  pdf = pdf_at(c, uv);
  return direction_from_square(map_, uv);
}

float DirectionTable::pdf(const Vec3& w) const {
  const Vec2 uv = square_from_direction(map_, w);
  return pdf_at(cell_at(uv), uv);
}

Vec2 DirectionTable::square_of(const Vec3& w) const {
  const Cell c = cell_at(square_from_direction(map_, w));
  const Corners n = corners(c);
  const float t = invert_line(n.at00 + n.at10, n.at01 + n.at11, c.place.y);
  const float s =
      invert_line(lerp(n.at00, n.at01, c.place.y), lerp(n.at10, n.at11, c.place.y), c.place.x);
  const float* x = row_cdf(c.y) + c.x;
  const float* y = cdf_y_.data() + c.y;
  return {lerp(x[0], x[1], s), lerp(y[0], y[1], t)};
}

}  // namespace troffer
