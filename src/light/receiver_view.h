// Geometry of a receiver and a piece of a light, shared by sampling, density and inverse
// (light_sample.h).
#pragma once

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "base/vec.h"
#include "light/light_primitive.h"
#include "light/polygon.h"
#include "light/spherical_disk.h"
#include "light/spherical_rectangle.h"
#include "light/spherical_triangle.h"

namespace troffer {

// Distance, in radii of the piece, beyond which sampling is by area (light_sample.h).
constexpr float far_in_radii = 32;
// Solid angle below which single precision would misplace a point by over 1e-4 of the rectangle's
// size.
constexpr float least_single_precision_sr = 2e-3f;
// Solid angle below which double precision cannot place points either, on a rectangle seen edge-on.
constexpr float least_rectangle_sr = 1e-8f;

// A receiver relative to a planar piece.
struct PlanarView {
  double height;  // distance of the receiver from the plane, metres
  bool is_front;
  bool is_visible;  // the receiver's side of the plane emits
  bool is_far;

  PlanarView(const LightPrimitive& p, const Vec3& x) {
    // Exact in double precision, because the coordinates are floats.
    const Vec3d y(p.vertex_count > 0 ? p.vertex(0) : p.centroid);
    const double signed_height = dot(p.normal, Vec3d(x) - y);
    is_front = signed_height > 0;
    height = std::abs(signed_height);
    is_visible = (is_front || p.is_two_sided) && height > plane_rounding(Vec3d(x), y);
    is_far = length_squared(x - p.centroid) > sqr(far_in_radii) * sqr(p.radius);
  }
  float pdf_from_area(const LightPrimitive& p, float distance) const {
    // distance² / (cos area), with cos = height / distance.
    return float(double(distance) * double(distance) * double(distance) /
                 (height * double(p.area)));
  }
};

template <class T>
SphericalRectangle<T> rectangle_from(const LightPrimitive& p, const Vec3& x, double height) {
  const T scale = 1 / T(p.radius);
  const Vec3T<T> corner = (Vec3T<T>(p.vertices[0]) - Vec3T<T>(x)) * scale;
  const T x0 = dot(corner, Vec3T<T>(p.axis_x)), y0 = dot(corner, Vec3T<T>(p.axis_y));
  return {x0, x0 + T(p.size_x) * scale, y0, y0 + T(p.size_y) * scale, T(height) * scale};
}

// Triangle (vertex 0, i+1, i+2) of the fan; vertex 0 is B of SphericalTriangle.
template <class T>
SphericalTriangle<T> fan_triangle(const LightPrimitive& p, const Vec3& x, double height,
                                  uint32_t i) {
  const Vec3T<T> origin(x);
  const Vec3T<T> b = Vec3T<T>(p.vertex(0)), a = Vec3T<T>(p.vertex(i + 1)),
                 c = Vec3T<T>(p.vertex(i + 2));
  const T twice_area =
      p.vertex_count == 3 ? 2 * T(p.area) : dot(cross(a - b, c - b), Vec3T<T>(p.normal));
  return {a - origin, b - origin, c - origin, twice_area * T(height)};
}

inline float fan_area(const LightPrimitive& p, uint32_t i) {
  if (p.vertex_count == 3) return p.area;
  const Vec3 b = p.vertex(0);
  return 0.5f *
         std::max(0.0f, dot(cross(p.vertex(i + 1) - b, p.vertex(i + 2) - b), Vec3(p.normal)));
}

// True if the receiver is so close to the plane that single precision would blur its height.
inline bool wants_double(const LightPrimitive& p, const PlanarView& view) {
  return view.height < 0.01 * double(p.radius);
}

// The disk in the coordinates of SphericalDisk: a towards the receiver's foot, b perpendicular.
struct DiskView {
  Vec3d a, b, up;
  SphericalDisk disk;

  DiskView(const LightPrimitive& p, const PlanarView& view, const Vec3& x)
      : a(p.axis_x), up(view.is_front ? p.normal : -p.normal), disk(0, 1) {
    const Vec3d from_centre = Vec3d(x) - Vec3d(p.centroid);
    const Vec3d foot = from_centre - up * view.height;
    const double rho = length(foot);
    if (rho > 1e-9 * double(p.radius)) a = foot / rho;
    b = cross(up, a);
    disk = SphericalDisk(rho / double(p.radius), view.height / double(p.radius));
  }
};

// Distance in metres by which points of the sphere may lie off it after rounding to float.
inline double rounding_of_sphere(const Vec3d& centre, double radius) {
  const Vec3d c = abs(centre);
  return 4e-7 * (radius + std::max({c.x, c.y, c.z}));
}

// A receiver relative to a sphere, in units of the radius. Receivers on the surface count as inside
// even if rounding puts them outside. So the inside lights itself, and the outside lights neither
// itself nor the inside.
struct SphereView {
  Vec3d to_centre;  // in radii
  double distance;
  bool is_inside, is_front, is_visible;

  SphereView(const LightPrimitive& p, const Vec3& x)
      : to_centre((Vec3d(p.centroid) - Vec3d(x)) / double(p.radius)), distance(length(to_centre)) {
    const double radius = p.radius;
    is_inside = distance <= 1 + rounding_of_sphere(Vec3d(p.centroid), radius) / radius;
    is_front = is_inside == p.is_inside_out;
    is_visible = is_front || p.is_two_sided;
  }
  // True if sampling can return this hit: the near end of a chord from outside, the far end from
  // inside.
  bool can_sample(const Vec3& wi, double hit_distance) const {
    return (hit_distance >= dot(Vec3d(wi), to_centre)) == is_inside;
  }
};

}  // namespace troffer
