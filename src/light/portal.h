// A rectangle through which alone an environment light is seen, as if the rectangle's plane were a
// wall elsewhere.
//
// Directions are given by two angles in the rectangle's axes, a = atan(x / z) and b = atan(y / z),
// with z pointing outside. Seen from any point, the rectangle is then bounded by constant a and b
// [1]. A summed-area table of the luminance over (a, b) gives the integral over any such rectangle.
// Directions are sampled in proportion to luminance by inversion, first in a, then in b.
//
// References: [1] Bitterli, Novák & Jarosz, "Portal-Masked Environment Map Sampling", EGSR 2015,
//   Section 3.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "base/box.h"
#include "base/quad.h"
#include "base/vec.h"
#include "light/source_surface.h"

namespace troffer {

class Portal {
 public:
  // corners: of the rectangle, counterclockwise seen from inside, where the light arrives.
  // luminance: by unit direction; it is evaluated in 4 n² directions.
  Portal(std::span<const Vec3> corners, int n, const std::function<float(const Vec3&)>& luminance);

  // True if x sees the light of direction wi through the rectangle.
  bool shows(const Vec3& x, const Vec3& wi) const;
  // Visibility from all of a box towards all of a distant parallelogram: `none` and `all` are
  // proved, else `some`.
  enum class View { none, some, all };
  View view(const Box& receivers, const Parallelogram& far) const {
    return view_within(0, receivers, far);
  }

  // Returns the plane around the rectangle, extending `reach` beyond its sides: four trapezoids
  // that share edges. They hide, from points inside, what the rectangle does not let through.
  std::array<Quad, 4> frame(double reach) const;
  // True if all rays from the box to the distant parallelogram provably meet the frame or the
  // rectangle.
  bool is_framed(double reach, const Box& receivers, const Parallelogram& far) const {
    return view_within(reach, receivers, far) == View::all;
  }

  // Samples a direction for receiver x. pdf: density per steradian. Returns false if x sees
  // nothing.
  bool sample(const Vec3& x, const Vec2& u, Vec3& wi, float& pdf) const;
  float pdf(const Vec3& x, const Vec3& wi) const;

  double area() const { return size_x_ * size_y_; }
  // Unit vectors along the sides, and outwards.
  std::array<Vec3d, 3> axes() const { return {x_, y_, z_}; }

 private:
  // A range of the table, in its cells.
  struct Range {
    double x0, x1, y0, y1;
  };
  // Components in the rectangle's axes. Places are relative to the first corner.
  Vec3d own(const Vec3d& v) const { return {dot(v, x_), dot(v, y_), dot(v, z_)}; }
  // view() for the rectangle enlarged by a margin on all sides.
  View view_within(double margin, const Box& receivers, const Parallelogram& far) const;
  bool range_from(const Vec3& x, Range& r) const;
  // Sum of all cells before a place of the table.
  double sum(double x, double y) const;
  double sum_to(const Range& r, double x) const {
    return (sum(x, r.y1) - sum(x, r.y0)) - (sum(r.x0, r.y1) - sum(r.x0, r.y0));
  }
  double density(double x, double y) const;
  // Area of the table's square [0,n]² per steradian, in direction (x, y, 1).
  double squares_per_steradian(double x, double y) const;

  Vec3d corner_, x_, y_, z_;
  double size_x_ = 0, size_y_ = 0;
  int n_;
  std::vector<double> sums_;  // (n + 1)²: sum of all cells before each corner
};

}  // namespace troffer
