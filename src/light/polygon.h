// Geometry of planar convex polygons: area vector, centroid, tests for parallelograms and
// rectangles, and the rounding margin of their planes.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "base/vec.h"

namespace troffer {

// Unit normal times area, on the side from which the vertices run counterclockwise.
inline Vec3d area_vector(std::span<const Vec3> polygon) {
  Vec3d sum;
  const Vec3d origin(polygon[0]);
  for (size_t i = 1; i + 1 < polygon.size(); ++i)
    sum += cross(Vec3d(polygon[i]) - origin, Vec3d(polygon[i + 1]) - origin);
  return sum * 0.5;
}

// Centroid of the area; the mean of the vertices if there is no area. normal: unit normal.
inline Vec3d centroid(std::span<const Vec3> polygon, const Vec3d& normal) {
  const Vec3d origin(polygon[0]);
  Vec3d sum, mean;
  double weight = 0;
  for (size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Vec3d e = Vec3d(polygon[i]) - origin, f = Vec3d(polygon[i + 1]) - origin;
    const double w = dot(cross(e, f), normal);
    sum += (e + f) * (w / 3);
    weight += w;
  }
  if (weight > 0) return origin + sum / weight;
  for (const Vec3& p : polygon) mean += Vec3d(p);
  return mean / double(polygon.size());
}

// Height in metres over the plane of a flat source through y, up to which a receiver x counts as in
// the plane and gets no light. Rounding can put a hit on the source's back onto its front side,
// where the source would fill its hemisphere. Rays are offset farther from surfaces than this.
inline double plane_rounding(const Vec3d& x, const Vec3d& y) {
  double sum = 0;
  for (const Vec3d& p : {x, y}) sum += std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return 0x1p-21 * sum;
}

// True for four vertices whose diagonals bisect each other, within 1e-5 of the diagonal or four
// units in the last place of the coordinates.
inline bool is_parallelogram(std::span<const Vec3> polygon) {
  if (polygon.size() != 4) return false;
  const Vec3d p0(polygon[0]), p1(polygon[1]), p2(polygon[2]), p3(polygon[3]);
  double largest = 0;
  for (const Vec3& p : polygon)
    for (size_t axis = 0; axis < 3; ++axis) largest = std::max(largest, std::abs(double(p[axis])));
  const double diagonal = std::max(length(p2 - p0), length(p3 - p1));
  return length(p0 + p2 - p1 - p3) <= std::max(1e-5 * diagonal, 0x1p-22 * largest);
}

// True for a parallelogram with right angles (cosine up to 1e-5).
inline bool is_rectangle(std::span<const Vec3> polygon) {
  if (!is_parallelogram(polygon)) return false;
  const Vec3d u = Vec3d(polygon[1]) - Vec3d(polygon[0]);
  const Vec3d v = Vec3d(polygon[3]) - Vec3d(polygon[0]);
  return std::abs(dot(u, v)) <= 1e-5 * length(u) * length(v);
}

}  // namespace troffer
