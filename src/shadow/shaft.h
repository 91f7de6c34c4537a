// Shafts: convex regions that contain every segment from a cluster of receivers to a source.
// gather_facets.h collects the facets inside. Lengths in metres.
// References: [1] Haines & Wallace, "Shaft Culling for Efficient Ray-Traced Radiosity", 1991.
#pragma once

#include <array>
#include <span>

#include "base/quad.h"
#include "base/vec.h"

namespace troffer {

// Convex body that contains the receivers of a cluster: a rectangle if they share a plane and a
// normal, else a box.
struct ReceiverHull {
  std::array<Vec3d, 8> corners;
  int count = 0;     // 4 or 8
  double slack = 0;  // distance that receivers may lie off the rectangle
  Vec3d centre;
  bool is_flat = false;
  Vec3d normal;          // common normal, if is_flat
  double lowest = 0;     // least normal · origin, if is_flat
  double magnitude = 0;  // largest absolute coordinate

  double radius() const;  // around the centre, without slack
  // Returns pairs of corner indices.
  std::span<const int[2]> edges() const;
};

// Returns the hull of receivers. origins: where their rays start; normals: unit, of their horizons.
// There must be at least one.
ReceiverHull bound_receivers(std::span<const Vec3> origins, std::span<const Vec3> normals);

// A convex region, given by planes whose normals point outwards.
struct Shaft {
  static constexpr int most_planes = 24;
  std::array<Plane, most_planes> planes;
  int count = 0;
  std::span<const Plane> all() const { return {planes.data(), size_t(count)}; }
};

// Returns the shaft from receivers to a flat source. outline: its corners; normal: unit, towards
// the receivers; scene_magnitude: largest coordinate of anything tested, for rounding. The planes
// exclude what lies behind the source, behind the common horizon of flat receivers, and outside the
// convex hull of both bodies. Planes of that hull pass through an edge of one body and a corner of
// the other [1].
Shaft make_shaft(const ReceiverHull& hull, std::span<const Vec3d> outline, const Vec3d& normal,
                 double scene_magnitude);

// Returns the shaft from receivers to the visible part of a sphere. It contains the convex hull of
// both, except what lies behind the receivers' common horizon or deeper than the caps that they
// see. All receivers must lie outside the sphere.
Shaft make_shaft(const ReceiverHull& hull, const Vec3d& centre, double radius,
                 double scene_magnitude);

// Distance by which planes are moved outwards, relative to the largest coordinate M, for single
// precision with u = 2^-24. The normal's components round by u each and the test's three products
// by 3 u, together 4 u (|nx| + |ny| + |nz|) M <= 4 sqrt(3) u M. The distance is at most sqrt(3) M
// and rounds by u of itself. Sum: 5 sqrt(3) u = 5.2e-7.
constexpr double shaft_margin = 6e-7;

}  // namespace troffer
