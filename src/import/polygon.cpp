#include "import/polygon.h"

#include <cmath>
#include <numeric>

namespace troffer {

namespace {

constexpr size_t max_ear_corners = 256;

// Returns Newell's normal, twice the area long: exact for planar polygons, robust for others.
Vec3d newell_normal(std::span<const Vec3> points) {
  Vec3d sum;
  const Vec3d origin(points[0]);
  for (size_t i = 1; i + 1 < points.size(); ++i)
    sum += cross(Vec3d(points[i]) - origin, Vec3d(points[i + 1]) - origin);
  return sum;
}

// Projects the points along the dominant axis of the normal, so that the polygon runs
// counterclockwise.
std::vector<Vec2d> projected(std::span<const Vec3> points, const Vec3d& normal) {
  const Vec3d size = abs(normal);
  const size_t axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
  const size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
  std::vector<Vec2d> out;
  out.reserve(points.size());
  for (const Vec3& p : points)
    out.push_back(normal[axis] < 0 ? Vec2d(p[b], p[a]) : Vec2d(p[a], p[b]));
  return out;
}

double turn(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  return (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x);
}

bool is_inside(const Vec2d& p, const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
}

bool is_convex_ring(const std::vector<Vec2d>& p) {
  const size_t n = p.size();
  for (size_t i = 0; i < n; ++i)
    if (turn(p[i], p[(i + 1) % n], p[(i + 2) % n]) < 0) return false;
  return true;
}

// True if corner `at` of the ring can be cut off: it is convex, and no other corner lies in its
// triangle.
bool is_ear(const std::vector<Vec2d>& p, const std::vector<uint32_t>& ring, size_t at) {
  const size_t n = ring.size(), before = (at + n - 1) % n, after = (at + 1) % n;
  const Vec2d &a = p[ring[before]], &b = p[ring[at]], &c = p[ring[after]];
  if (!(turn(a, b, c) > 0)) return false;
  for (size_t i = 0; i < n; ++i) {
    if (i == before || i == at || i == after) continue;
    const Vec2d& q = p[ring[i]];
    // A corner at the same position as one of the ear's is no obstacle.
    if (q == a || q == b || q == c) continue;
    if (is_inside(q, a, b, c)) return false;
  }
  return true;
}

void cut_ears(const std::vector<Vec2d>& p, std::vector<uint32_t>& ring,
              std::vector<Triangle>& triangles) {
  size_t at = 0, failures = 0;
  size_t budget = 8 * p.size();  // ear tests; each takes linear time
  while (ring.size() > 3 && failures < ring.size() && budget-- > 0) {
    const size_t n = ring.size();
    if (!is_ear(p, ring, at)) {
      at = (at + 1) % n;
      ++failures;
      continue;
    }
    triangles.push_back({ring[(at + n - 1) % n], ring[at], ring[(at + 1) % n]});
    ring.erase(ring.begin() + std::ptrdiff_t(at));
    at %= ring.size();
    failures = 0;
  }
}

}  // namespace

void triangulate(std::span<const Vec3> points, std::vector<Triangle>& triangles) {
  std::vector<uint32_t> ring(points.size());
  std::iota(ring.begin(), ring.end(), 0u);
  if (points.size() > 3 && points.size() <= max_ear_corners) {
    const std::vector<Vec2d> p = projected(points, newell_normal(points));
    if (!is_convex_ring(p)) cut_ears(p, ring, triangles);
  }
  for (size_t i = 2; i < ring.size(); ++i) triangles.push_back({ring[0], ring[i - 1], ring[i]});
}

}  // namespace troffer
