// A rectangle that a light at infinity comes through alone, as if its plane were a wall elsewhere:
// from a place the light is seen in the directions that leave through the rectangle.
//
// Directions are drawn by two angles in the rectangle's own axes, a = atan(x / z) and b = atan(y /
// z), z being what is outside. From everywhere the rectangle is one of sides of constant a and b
// [1], over which the luminance is summed once for all: sums over rectangles that begin at the
// corner of a table give the integral over any other, and directions in proportion to it by
// inversion, first of a, then of b.
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
  // corners: of the rectangle, counterclockwise seen from inside, where the light arrives. The
  // luminance in a unit direction is looked at in 4 n² of them.
  Portal(std::span<const Vec3> corners, int n, const std::function<float(const Vec3&)>& luminance);

  // Whether what is in the direction wi beyond the rectangle is seen from x.
  bool shows(const Vec3& x, const Vec3& wi) const;
  // Whether it is from all of a box, in the directions to all of a parallelogram far away: proved,
  // or some.
  enum class View { none, some, all };
  View view(const Box& receivers, const Parallelogram& far) const {
    return view_within(0, receivers, far);
  }

  // The plane about the rectangle, as far as `reach` beyond its sides: four trapezoids that share
  // their edges with it and with each other, and hide from places before the plane what they do not
  // let through the rectangle.
  std::array<Quad, 4> frame(double reach) const;
  // Whether rays from all of a box to all of a parallelogram far away meet the frame, or the
  // rectangle within it: proved.
  bool is_framed(double reach, const Box& receivers, const Parallelogram& far) const {
    return view_within(reach, receivers, far) == View::all;
  }

  // A direction for the receiver x, and its density per steradian; false where it sees nothing.
  bool sample(const Vec3& x, const Vec2& u, Vec3& wi, float& pdf) const;
  float pdf(const Vec3& x, const Vec3& wi) const;

  double area() const { return size_x_ * size_y_; }
  // Unit: along the sides, and towards what is outside.
  std::array<Vec3d, 3> axes() const { return {x_, y_, z_}; }

 private:
  // Of the table, in its cells.
  struct Range {
    double x0, x1, y0, y1;
  };
  // In the rectangle's axes: of directions, and places from its first corner.
  Vec3d own(const Vec3d& v) const { return {dot(v, x_), dot(v, y_), dot(v, z_)}; }
  // view() of the rectangle grown by a margin on all sides.
  View view_within(double margin, const Box& receivers, const Parallelogram& far) const;
  bool range_from(const Vec3& x, Range& r) const;
  // Of all cells before a place.
  double sum(double x, double y) const;
  double sum_to(const Range& r, double x) const {
    return (sum(x, r.y1) - sum(x, r.y0)) - (sum(r.x0, r.y1) - sum(r.x0, r.y0));
  }
  double density(double x, double y) const;
  // Of the square [0,n]² that the table covers, per steradian, towards (x, y, 1).
  double squares_per_steradian(double x, double y) const;

  Vec3d corner_, x_, y_, z_;
  double size_x_ = 0, size_y_ = 0;
  int n_;
  std::vector<double> sums_;  // (n + 1)²: of all cells before
};

}  // namespace troffer
