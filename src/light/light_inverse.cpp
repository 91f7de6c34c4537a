// square_from_point(): the inverses of light_sample.cpp, in double precision.
#include <cmath>

#include "base/frame.h"
#include "base/warp.h"
#include "light/light_sample.h"
#include "light/receiver_view.h"
#include "light/spherical_cap.h"

namespace troffer {

namespace {

Vec2d inverse_rectangle(const LightPrimitive& p, const PlanarView& view, const Vec3& x,
                        const Vec3d& from_vertex) {
  const double along_x = dot(from_vertex, Vec3d(p.axis_x)),
               along_y = dot(from_vertex, Vec3d(p.axis_y));
  if (!view.is_far && rectangle_from<float>(p, x, view.height).solid_angle >= least_rectangle_sr) {
    const auto rectangle = rectangle_from<double>(p, x, view.height);
    const double scale = 1 / double(p.radius);
    return rectangle.square_from_point(
        {rectangle.x0 + along_x * scale, rectangle.y0 + along_y * scale});
  }
  return {along_x / double(p.size_x), along_y / double(p.size_y)};
}

// Returns the barycentric coordinates of a point of the plane in fan triangle i.
Barycentric<double> fan_barycentric(const LightPrimitive& p, uint32_t i, const Vec3d& from_vertex) {
  const Vec3d b(p.vertex(0));
  const Vec3d a = Vec3d(p.vertex(i + 1)) - b, c = Vec3d(p.vertex(i + 2)) - b;
  const Vec3d n = cross(a, c);
  const double nn = length_squared(n);
  if (!(nn > 0)) return {-1, 3, -1};
  const double wa = dot(cross(from_vertex, c), n) / nn, wc = dot(cross(a, from_vertex), n) / nn;
  return {wa, 1 - wa - wc, wc};
}

Vec2d inverse_fan(const LightPrimitive& p, const PlanarView& view, const Vec3& x,
                  const Vec3d& from_vertex) {
  const uint32_t count = p.vertex_count - 2;
  // Pick the triangle whose angle at vertex 0 contains the point best.
  uint32_t picked = 0;
  double best = -1e300;
  for (uint32_t i = 0; i < count; ++i) {
    const Barycentric<double> w = fan_barycentric(p, i, from_vertex);
    const double inside = std::min(w.a, w.c);
    if (inside > best) {
      best = inside;
      picked = i;
    }
  }
  Barycentric<double> w = fan_barycentric(p, picked, from_vertex);
  w.a = std::max(w.a, 0.0);
  w.c = std::max(w.c, 0.0);
  w.b = std::max(1 - w.a - w.c, 0.0);
  double before = 0, total = 0, own = 0;
  for (uint32_t i = 0; i < count; ++i) {
    const double weight = view.is_far ? double(fan_area(p, i))
                                      : fan_triangle<double>(p, x, view.height, i).solid_angle;
    if (i < picked) before += weight;
    if (i == picked) own = weight;
    total += weight;
  }
  Vec2d u;
  if (view.is_far) {
    const double radial = w.a + w.c;
    u = {radial > 0 ? w.c / radial : 0, radial * radial};
  } else {
    u = fan_triangle<double>(p, x, view.height, picked).square_from_point(w);
  }
  return {(before + u.x * own) / total, u.y};
}

Vec2d inverse_disk(const LightPrimitive& p, const PlanarView& view, const Vec3& x,
                   const Vec3d& from_centre) {
  const Vec3d q = from_centre / double(p.radius);
  if (view.is_far) return square_from_disk(Vec2d{dot(q, Vec3d(p.axis_x)), dot(q, Vec3d(p.axis_y))});
  const DiskView local(p, view, x);
  return local.disk.square_from_point({dot(q, local.a), dot(q, local.b)});
}

Vec2d inverse_sphere(const LightPrimitive& p, const Vec3& x, const Vec3& point) {
  const SphereView view(p, x);
  const Vec3d to_point = Vec3d(point) - Vec3d(x);
  if (view.is_inside) return Vec2d(square_from_sphere(Vec3(normalize(to_point))));
  const Framed frame(view.to_centre / view.distance);
  return SphericalCap(view.distance).square_from_direction(frame.to_local(to_point));
}

}  // namespace

Vec2 square_from_point(const LightPrimitive& p, const Vec3& x, const Vec3& point) {
  if (p.shape == PrimitiveShape::sphere) return Vec2(inverse_sphere(p, x, point));
  const PlanarView view(p, x);
  if (p.shape == PrimitiveShape::disk)
    return Vec2(inverse_disk(p, view, x, Vec3d(point) - Vec3d(p.centroid)));
  const Vec3d from_vertex = Vec3d(point) - Vec3d(p.vertex(0));
  return Vec2(p.shape == PrimitiveShape::rectangle ? inverse_rectangle(p, view, x, from_vertex)
                                                   : inverse_fan(p, view, x, from_vertex));
}

}  // namespace troffer
