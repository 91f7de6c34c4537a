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

// The disk that the sphere's outline spans from x, as its bounding square.
Parallelogram outline_of(const SphereSource& s, const Vec3d& x) {
  const Vec3d axis = s.centre - x;
  const double distance = length(axis), sine = s.radius / distance;
  const Framed frame(axis / distance);
  const double radius = s.radius * std::sqrt(std::max(1 - sine * sine, 0.0));
  const Vec3d centre = s.centre - frame.normal * (s.radius * sine);
  const Vec3d u = frame.tangent * (2 * radius), v = frame.bitangent * (2 * radius);
  return {centre - (u + v) * 0.5, u, v, -frame.normal};
}

// Whether a facet may reach into the sphere, where it would hide the disk but not the cap.
bool may_enter(const Quad& q, const SphereSource& s) {
  Vec3d lower(q[0]), upper = lower;
  for (const Vec3& v : q) {
    lower = min(lower, Vec3d(v));
    upper = max(upper, Vec3d(v));
  }
  const Vec3d nearest = max(lower, min(upper, s.centre));
  return length(nearest - s.centre) < s.radius * (1 + 1e-6);
}

}  // namespace troffer
