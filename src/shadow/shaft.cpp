#include "shadow/shaft.h"

#include <algorithm>
#include <cmath>

#include "base/frame.h"

namespace troffer {

namespace {

double largest_coordinate(const Vec3d& p) {
  return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

// Returns the direction of the largest spread of the points within the frame's plane.
Vec3d main_direction(std::span<const Vec3> points, const Framed& frame, const Vec3d& centre) {
  double xx = 0, xy = 0, yy = 0;
  for (const Vec3& p : points) {
    const Vec3d d = frame.to_local(Vec3d(p) - centre);
    xx += d.x * d.x;
    xy += d.x * d.y;
    yy += d.y * d.y;
  }
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
  return frame.tangent * std::cos(angle) + frame.bitangent * std::sin(angle);
}

}  // namespace

double ReceiverHull::radius() const {
  double most = 0;
  for (int i = 0; i < count; ++i) most = std::max(most, length(corners[size_t(i)] - centre));
  return most;
}

std::span<const int[2]> ReceiverHull::edges() const {
  static constexpr int box[12][2] = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3},
                                     {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  static constexpr int rectangle[4][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  if (is_flat) return rectangle;
  return box;
}

ReceiverHull bound_receivers(std::span<const Vec3> origins, std::span<const Vec3> normals) {
  ReceiverHull hull;
  Vec3d lower(origins[0]), upper = lower;
  hull.is_flat = true;
  hull.normal = Vec3d(normals[0]);
  for (size_t i = 0; i < origins.size(); ++i) {
    const Vec3d p(origins[i]);
    lower = min(lower, p);
    upper = max(upper, p);
    hull.magnitude = std::max(hull.magnitude, largest_coordinate(p));
    hull.is_flat = hull.is_flat && length_squared(Vec3d(normals[i]) - hull.normal) < 1e-12;
  }
  hull.centre = (lower + upper) * 0.5;
  double highest = 0;
  if (hull.is_flat) {
    hull.lowest = highest = dot(hull.normal, Vec3d(origins[0]));
    for (const Vec3& o : origins) {
      const double h = dot(hull.normal, Vec3d(o));
      hull.lowest = std::min(hull.lowest, h);
      highest = std::max(highest, h);
    }
    hull.slack = highest - hull.lowest;
    hull.is_flat = hull.slack <= 1e-6 * hull.magnitude;
  }
  if (!hull.is_flat) {
    hull.slack = 0;
    hull.count = 8;
    for (size_t i = 0; i < 8; ++i)
      hull.corners[i] = {(i & 1) != 0 ? upper.x : lower.x, (i & 2) != 0 ? upper.y : lower.y,
                         (i & 4) != 0 ? upper.z : lower.z};
    return hull;
  }
  const Framed frame(hull.normal);
  const Vec3d along = main_direction(origins, frame, hull.centre);
  const Vec3d across = cross(hull.normal, along);
  double least_a = 0, most_a = 0, least_b = 0, most_b = 0;
  for (const Vec3& o : origins) {
    const Vec3d d = Vec3d(o) - hull.centre;
    const double a = dot(d, along), b = dot(d, across);
    least_a = std::min(least_a, a);
    most_a = std::max(most_a, a);
    least_b = std::min(least_b, b);
    most_b = std::max(most_b, b);
  }
  const Vec3d base =
      hull.centre + hull.normal * (0.5 * (hull.lowest + highest) - dot(hull.normal, hull.centre));
  hull.count = 4;
  hull.corners[0] = base + along * least_a + across * least_b;
  hull.corners[1] = base + along * most_a + across * least_b;
  hull.corners[2] = base + along * most_a + across * most_b;
  hull.corners[3] = base + along * least_a + across * most_b;
  return hull;
}

namespace {

struct Bodies {
  std::span<const Vec3d> a, b;
};

// Adds the plane through edge (p, q) of one body and a corner of the other, if both bodies lie on
// one side of it. `inner` is a point of the own body off the edge. Of the two tangent planes at the
// edge, the loop turns to the one that has both bodies on the same side.
void add_tangent(const Bodies& bodies, const Vec3d& p, const Vec3d& q, const Vec3d& inner,
                 std::span<const Vec3d> other, double margin, double tolerance, Shaft& shaft) {
  const Vec3d e = q - p;
  Vec3d normal;
  for (const Vec3d& c : other) {
    const Vec3d d = c - p;
    if (length_squared(normal) > 0 && dot(normal, d) <= 0) continue;
    const Vec3d n = cross(e, d);
    normal = dot(n, inner - p) <= 0 ? n : -n;
  }
  const double size = length(normal);
  if (!(size > 0)) return;
  const Vec3d unit = normal / size;
  const double distance = dot(unit, p);
  double most = 0;
  for (const std::span<const Vec3d> body : {bodies.a, bodies.b})
    for (const Vec3d& v : body) most = std::max(most, dot(unit, v) - distance);
  if (most > tolerance || shaft.count >= Shaft::most_planes) return;
  shaft.planes[size_t(shaft.count++)] = {Vec3(unit), float(distance + most + margin)};
}

}  // namespace

Shaft make_shaft(const ReceiverHull& hull, std::span<const Vec3d> outline, const Vec3d& normal,
                 double scene_magnitude) {
  Shaft shaft;
  // Planes are tested in single precision against coordinates up to scene_magnitude.
  const double margin = shaft_margin * std::max(scene_magnitude, hull.magnitude);
  const std::span<const Vec3d> corners(hull.corners.data(), size_t(hull.count));
  double lowest = dot(normal, outline[0]);
  for (const Vec3d& v : outline) lowest = std::min(lowest, dot(normal, v));
  // Occluders that rise less than 2e-6 of the largest coordinate over the source's plane hide
  // nothing: the source itself, or the ceiling around it. Rays ignore them too (trace_rays.cpp).
  double largest = hull.magnitude;
  for (const Vec3d& v : outline) largest = std::max(largest, largest_coordinate(v));
  shaft.planes[0] = {Vec3(-normal), float(-lowest - 2e-6 * largest)};
  shaft.count = 1;
  if (hull.is_flat)
    shaft.planes[size_t(shaft.count++)] = {Vec3(-hull.normal), float(-hull.lowest + margin)};

  const Bodies bodies{corners, outline};
  const double tolerance = 1e-9 * std::max(scene_magnitude, hull.magnitude);
  const double slack = margin + hull.slack;
  const size_t n = outline.size();
  for (size_t i = 0; i < n; ++i)
    add_tangent(bodies, outline[i], outline[(i + 1) % n], outline[(i + 2) % n], corners, slack,
                tolerance, shaft);
  // For a box, no single corner tells the inner side of every plane at an edge, so both sides are
  // tried.
  for (const auto& e : hull.edges()) {
    const Vec3d &p = corners[size_t(e[0])], &q = corners[size_t(e[1])];
    if (hull.is_flat) {
      add_tangent(bodies, p, q, corners[size_t(e[1] + 1) % 4], outline, slack, tolerance, shaft);
      continue;
    }
    for (const Vec3d& inner : corners)
      if (length_squared(inner - p) > 0 && length_squared(inner - q) > 0) {
        const int before = shaft.count;
        add_tangent(bodies, p, q, inner, outline, slack, tolerance, shaft);
        if (shaft.count > before) break;
      }
  }
  return shaft;
}

}  // namespace troffer
