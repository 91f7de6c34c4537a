// Triangles in a plane: what of them overlaps, and what of them lies in a square.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "base/vec.h"

namespace troffer {

using FlatTriangle = std::array<Vec2d, 3>;

// Twice the area, positive where the corners run counterclockwise.
inline double doubled_area(const FlatTriangle& t) {
  const Vec2d a = t[1] - t[0], b = t[2] - t[0];
  return a.x * b.y - a.y * b.x;
}

// A convex polygon: a triangle cut by half planes, each of which adds one corner at most.
struct FlatPolygon {
  std::array<Vec2d, 8> corners;
  size_t size = 0;

  FlatPolygon() = default;
  explicit FlatPolygon(const FlatTriangle& t) : size(3) {
    for (size_t k = 0; k < 3; ++k) corners[k] = t[k];
  }
  // Keeps where normal · p <= distance.
  void cut(const Vec2d& normal, double distance);
  // Never negative, whichever way the corners run.
  double area() const;
};

FlatPolygon in_square(const FlatTriangle& triangle, double x0, double y0, double x1, double y1);

// Whether two triangles have more in common than a thousandth of the smaller one's area: more than
// rounding makes of edges that they share.
bool overlap(const FlatTriangle& a, const FlatTriangle& b);

// Triangles that have been laid down, none over another.
class LaidTriangles {
 public:
  // cell: about the size of a triangle.
  explicit LaidTriangles(double cell) : cell_(cell > 0 ? cell : 1) {}
  // Lays it down; false, and nothing is done, where it would lie over another.
  bool add(const FlatTriangle& triangle);

 private:
  double cell_;
  std::vector<FlatTriangle> all_;
  std::unordered_map<uint64_t, std::vector<uint32_t>> cells_;
  std::vector<uint32_t> everywhere_;  // those that would be in too many cells
};

}  // namespace troffer
