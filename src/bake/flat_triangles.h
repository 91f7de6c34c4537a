// Triangles in a plane: overlaps between them, and their parts within squares. Charts and atlases
// use them.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "base/vec.h"

namespace troffer {

using FlatTriangle = std::array<Vec2d, 3>;

// Twice the area; positive if the corners run counterclockwise.
inline double doubled_area(const FlatTriangle& t) {
  const Vec2d a = t[1] - t[0], b = t[2] - t[0];
  return a.x * b.y - a.y * b.x;
}

// A convex polygon: a triangle clipped by half planes, each of which adds at most one corner.
struct FlatPolygon {
  std::array<Vec2d, 8> corners;
  size_t size = 0;

  FlatPolygon() = default;
  explicit FlatPolygon(const FlatTriangle& t) : size(3) {
    for (size_t k = 0; k < 3; ++k) corners[k] = t[k];
  }
  // Keeps the part with normal · p <= distance.
  void cut(const Vec2d& normal, double distance);
  // Never negative, in either orientation.
  double area() const;
};

// Returns the part of a triangle within a rectangle.
FlatPolygon in_square(const FlatTriangle& triangle, double x0, double y0, double x1, double y1);

// True if two triangles share more than a thousandth of the smaller one's area. Smaller overlaps
// come from rounding at shared edges.
bool overlap(const FlatTriangle& a, const FlatTriangle& b);

// A set of triangles without overlaps.
class LaidTriangles {
 public:
  // cell: side of the cells of the search grid, about the size of a triangle.
  explicit LaidTriangles(double cell) : cell_(cell > 0 ? cell : 1) {}
  // Adds a triangle. Returns false and changes nothing if it would overlap another.
  bool add(const FlatTriangle& triangle);

 private:
  double cell_;
  std::vector<FlatTriangle> all_;
  std::unordered_map<uint64_t, std::vector<uint32_t>> cells_;
  std::vector<uint32_t> everywhere_;  // triangles that would cover too many cells
};

}  // namespace troffer
