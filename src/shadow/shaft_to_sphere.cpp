// Shafts to spheres (shaft.h). Every plane supports the convex hull of receivers and sphere, so any
// choice of directions is correct. The directions are chosen for a tight shaft
// (docs/method/certified-appendix.md, "Spheres").
#include <algorithm>
#include <cmath>

#include "base/frame.h"
#include "base/units.h"
#include "shadow/shaft.h"

namespace troffer {

namespace {

// The corners of a receiver hull and a sphere.
struct HullAndBall {
  std::span<const Vec3d> corners;
  Vec3d centre;
  double radius;

  // Returns the largest n · p over the corners, relative to the centre.
  double most_of_corners(const Vec3d& n) const {
    double most = dot(n, corners[0] - centre);
    for (const Vec3d& c : corners) most = std::max(most, dot(n, c - centre));
    return most;
  }
};

// Adds the supporting plane with unit normal n. must_touch: skip it unless it touches the sphere.
void add_support(const HullAndBall& bodies, const Vec3d& n, double slack, bool must_touch,
                 Shaft& shaft) {
  const double most = bodies.most_of_corners(n);
  if (must_touch && most > bodies.radius * (1 + 1e-6)) return;
  if (shaft.count >= Shaft::most_planes) return;
  const double reach = std::max(most, bodies.radius);
  shaft.planes[size_t(shaft.count++)] = {Vec3(n), float(dot(n, bodies.centre) + reach + slack)};
}

// Adds the plane that touches the sphere on the side `across` of the axis from the centre to the
// receivers. It leans towards the axis until it meets a corner of the hull.
void add_side(const HullAndBall& bodies, const Vec3d& along, const Vec3d& across, double slack,
              Shaft& shaft) {
  double angle = pi / 2;
  for (const Vec3d& c : bodies.corners) {
    const double x = dot(c - bodies.centre, across), y = dot(c - bodies.centre, along);
    const double distance = std::hypot(x, y);
    if (distance > bodies.radius)
      angle = std::min(angle, std::atan2(y, x) - std::acos(bodies.radius / distance));
  }
  add_support(bodies, across * std::cos(angle) + along * std::sin(angle), slack, false, shaft);
}

// Adds the planes through an edge of the hull that touch the sphere.
void add_edge(const HullAndBall& bodies, const Vec3d& p, const Vec3d& q, double slack,
              Shaft& shaft) {
  const double size = length(q - p);
  if (!(size > 0)) return;
  const Vec3d edge = (q - p) / size, to_centre = bodies.centre - p;
  const Vec3d away = to_centre - edge * dot(to_centre, edge);
  const double distance = length(away);
  if (!(distance > bodies.radius)) return;
  const Vec3d w = away / distance, side = cross(edge, w);
  const double sine = bodies.radius / distance, cosine = std::sqrt((1 - sine) * (1 + sine));
  for (const double sign : {-1.0, 1.0})
    add_support(bodies, side * (sign * cosine) - w * sine, slack, true, shaft);
}

// Returns the depth of the visible caps: their least height over the centre along the axis to the
// receivers' bounding ball. For a receiver at distance d, `off` away from the axis, the cap ends
// acos(radius / d) from the receiver's direction.
double depth_of_caps(const ReceiverHull& hull, double reach, double distance, double radius) {
  const double off = std::asin(std::min(reach / distance, 1.0));
  const double cap = std::acos(std::min(radius / (distance + reach), 1.0));
  return radius * std::cos(std::min(off + cap, pi)) - hull.slack;
}

}  // namespace

Shaft make_shaft(const ReceiverHull& hull, const Vec3d& centre, double radius,
                 double scene_magnitude) {
  Shaft shaft;
  double magnitude = std::max(scene_magnitude, hull.magnitude);
  for (size_t a = 0; a < 3; ++a) magnitude = std::max(magnitude, std::abs(centre[a]) + radius);
  const double reach = hull.slack + hull.radius();
  const double margin = shaft_margin * magnitude, slack = margin + hull.slack;
  const HullAndBall bodies{{hull.corners.data(), size_t(hull.count)}, centre, radius};
  const Vec3d axis = hull.centre - centre;
  const double distance = length(axis);
  const Framed frame(axis / distance);
  const double depth = depth_of_caps(hull, reach, distance, radius);
  shaft.planes[0] = {Vec3(-frame.normal), float(-dot(frame.normal, centre) - depth + margin)};
  shaft.count = 1;
  if (hull.is_flat)
    shaft.planes[size_t(shaft.count++)] = {Vec3(-hull.normal), float(-hull.lowest + margin)};
  constexpr int sides = 8;
  for (int i = 0; i < sides; ++i) {
    const double a = 2 * pi * i / sides;
    const Vec3d across = frame.tangent * std::cos(a) + frame.bitangent * std::sin(a);
    add_side(bodies, frame.normal, across, slack, shaft);
  }
  for (const auto& e : hull.edges())
    add_edge(bodies, hull.corners[size_t(e[0])], hull.corners[size_t(e[1])], slack, shaft);
  return shaft;
}

}  // namespace troffer
