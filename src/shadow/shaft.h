// Shafts: convex regions that hold every segment from a cluster of receivers to a source.
// References: [1] Haines & Wallace, "Shaft Culling for Efficient Ray-Traced Radiosity", 1991.
#pragma once

#include <array>
#include <span>

#include "base/quad.h"
#include "base/vec.h"

namespace troffer {

// A convex body that holds the receivers of a cluster: a rectangle where they lie in one plane and
// share a normal, else a box.
struct ReceiverHull {
  std::array<Vec3d, 8> corners;
  int count = 0;     // 4 or 8
  double slack = 0;  // metres that receivers may lie off the rectangle
  Vec3d centre;
  bool is_flat = false;
  Vec3d normal;          // flat: the common normal
  double lowest = 0;     // flat: least normal · origin
  double magnitude = 0;  // largest coordinate

  double radius() const;  // about the centre, without slack
  // Pairs of corners.
  std::span<const int[2]> edges() const;
};

// origins: where rays of the receivers start; normals: unit, of their horizons; at least one.
ReceiverHull bound_receivers(std::span<const Vec3> origins, std::span<const Vec3> normals);

struct Shaft {
  static constexpr int most_planes = 24;
  std::array<Plane, most_planes> planes;
  int count = 0;
  std::span<const Plane> all() const { return {planes.data(), size_t(count)}; }
};

// The shaft from receivers to a flat source. `outline`: its corners; normal: unit, on the side of
// the receivers. scene_magnitude: largest coordinate of what will be tested, for rounding. Leaves
// out what lies behind the source's plane, behind the common horizon of flat receivers, and outside
// the hull [1], whose planes pass through an edge of one body and a corner of the other.
Shaft make_shaft(const ReceiverHull& hull, std::span<const Vec3d> outline, const Vec3d& normal,
                 double scene_magnitude);

// The shaft from receivers to what they see of a sphere: it holds the convex hull of receivers and
// sphere, but for what lies deeper than the caps that any of them sees and behind their common
// horizon. All receivers lie outside the sphere.
Shaft make_shaft(const ReceiverHull& hull, const Vec3d& centre, double radius,
                 double scene_magnitude);

// How far planes are pushed outwards, as a share of the largest coordinate M, for their rounding
// and that of the test in single precision, u = 2^-24: the normal's components round by u each and
// the test's three products by 3 u, together 4 u (|nx| + |ny| + |nz|) M <= 4 sqrt(3) u M, and the
// distance, at most sqrt(3) M, by u of itself: 5 sqrt(3) u = 5.2e-7.
constexpr double shaft_margin = 6e-7;

}  // namespace troffer
