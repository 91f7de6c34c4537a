#include "shadow/shadow_source.h"

#include <algorithm>

#include "light/polygon.h"

namespace troffer {

std::vector<Vec3d> FlatSource::corners() const {
  const auto at = [&](double u, double v) { return plane.origin + plane.u * u + plane.v * v; };
  if (outline.empty()) return {at(0, 0), at(1, 0), at(1, 1), at(0, 1)};
  std::vector<Vec3d> c;
  for (const Vec2& p : outline) c.push_back(at(double(p.x), double(p.y)));
  return c;
}

namespace {

// The rectangle along one side of the polygon that bounds it, in coordinates along x and y.
struct Bounding {
  Vec3d x, y;
  Vec2d lower, upper;
  double area() const { return (upper.x - lower.x) * (upper.y - lower.y); }
};

Bounding bounding_along(std::span<const Vec3> polygon, const Vec3d& normal, size_t side) {
  const Vec3d origin(polygon[0]);
  Bounding b;
  b.x = normalize(Vec3d(polygon[(side + 1) % polygon.size()]) - Vec3d(polygon[side]));
  b.y = cross(normal, b.x);
  for (const Vec3& v : polygon) {
    const Vec3d d = Vec3d(v) - origin;
    b.lower = {std::min(b.lower.x, dot(d, b.x)), std::min(b.lower.y, dot(d, b.y))};
    b.upper = {std::max(b.upper.x, dot(d, b.x)), std::max(b.upper.y, dot(d, b.y))};
  }
  return b;
}

}  // namespace

bool make_flat_source(const LightPrimitive& piece, bool is_back, FlatSource& out) {
  out = FlatSource();
  if (piece.shape == PrimitiveShape::sphere) return false;
  if (piece.shape == PrimitiveShape::disk) {
    const Vec3d u = Vec3d(piece.axis_x) * (2 * double(piece.radius));
    const Vec3d v = Vec3d(piece.axis_y) * (2 * double(piece.radius));
    out.plane = {Vec3d(piece.centroid) - (u + v) * 0.5, u, v, piece.normal};
    out.is_disk = true;
  } else if (!make_flat_source({&piece.vertex(0), piece.vertex_count}, out)) {
    return false;
  }
  if (is_back) out.plane.normal = -out.plane.normal;
  return true;
}

bool make_flat_source(std::span<const Vec3> polygon, FlatSource& out) {
  out = FlatSource();
  if (polygon.size() < 3 || polygon.size() > most_outline_corners) return false;
  const Vec3d area = area_vector(polygon);
  if (!(length_squared(area) > 0) || !is_finite(area)) return false;
  const Vec3d normal = normalize(area), origin(polygon[0]);
  if (polygon.size() == 3 || is_parallelogram(polygon)) {
    out.plane = {origin, Vec3d(polygon[1]) - origin, Vec3d(polygon.back()) - origin, normal};
    if (polygon.size() == 3) out.outline = {{0, 0}, {1, 0}, {0, 1}};
    return true;
  }
  Bounding best = bounding_along(polygon, normal, 0);
  for (size_t side = 1; side < polygon.size(); ++side) {
    const Bounding b = bounding_along(polygon, normal, side);
    if (b.area() < (1 - 1e-6) * best.area()) best = b;
  }
  const Vec2d size = best.upper - best.lower;
  if (!(size.x > 0) || !(size.y > 0)) return false;
  out.plane = {origin + best.x * best.lower.x + best.y * best.lower.y, best.x * size.x,
               best.y * size.y, normal};
  for (const Vec3& v : polygon) {
    const Vec3d d = Vec3d(v) - origin;
    out.outline.push_back({float((dot(d, best.x) - best.lower.x) / size.x),
                           float((dot(d, best.y) - best.lower.y) / size.y)});
  }
  return true;
}

}  // namespace troffer
