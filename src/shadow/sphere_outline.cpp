#include "shadow/sphere_outline.h"

#include <algorithm>
#include <cmath>

#include "base/frame.h"

namespace troffer {

bool is_near(const SphereSource& s, const ReceiverHull& hull) {
  double reach = hull.slack;
  for (int i = 0; i < hull.count; ++i)
    reach = std::max(reach, hull.slack + length(hull.corners[size_t(i)] - hull.centre));
  return !(length(s.centre - hull.centre) > reach + 1.05 * s.radius);
}

Parallelogram outline_of(const SphereSource& s, const Vec3d& x) {
  const Vec3d axis = s.centre - x;
  const double distance = length(axis), sine = s.radius / distance;
  const Framed frame(axis / distance);
  const double radius = s.radius * std::sqrt(std::max(1 - sine * sine, 0.0));
  const Vec3d centre = s.centre - frame.normal * (s.radius * sine);
  const Vec3d u = frame.tangent * (2 * radius), v = frame.bitangent * (2 * radius);
  return {centre - (u + v) * 0.5, u, v, -frame.normal};
}

bool may_enter(const Quad& q, const SphereSource& s) {
  const double radius = s.radius * (1 + 1e-6) + 1e-6 * length(s.centre);
  Vec3d corners[4];
  for (size_t i = 0; i < 4; ++i) corners[i] = Vec3d(q[i]) - s.centre;
  const Vec3d area = cross(corners[2] - corners[0], corners[3] - corners[1]);
  const double size = length(area);
  bool is_inside_edges = size > 0;  // the plane's nearest point lies on the facet
  for (size_t i = 0; i < 4; ++i) {
    const Vec3d &a = corners[i], b = corners[(i + 1) % 4], way = b - a;
    const double square = length_squared(way);
    const double t = square > 0 ? std::clamp(-dot(a, way) / square, 0.0, 1.0) : 0;
    if (length(a + way * t) < radius) return true;
    is_inside_edges = is_inside_edges && dot(cross(way, -a), area) >= 0;
  }
  return is_inside_edges && std::abs(dot(area, corners[0])) < radius * size;
}

bool is_within(const Quad& q, const SphereSource& s) {
  for (const Vec3& v : q)
    if (!(length(Vec3d(v) - s.centre) < s.radius)) return false;
  return true;
}

bool is_within(const RoundBody& body, const SphereSource& s) {
  return length(Vec3d(body.centre) - s.centre) + double(body.radius) < s.radius;
}

}  // namespace troffer
