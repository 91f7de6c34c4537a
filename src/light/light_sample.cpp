#include "light/light_sample.h"

#include <cmath>

#include "base/frame.h"
#include "base/prefetch.h"
#include "base/simd.h"
#include "base/units.h"
#include "base/warp.h"
#include "light/receiver_view.h"
#include "light/spherical_cap.h"

namespace troffer {

namespace {

bool finish(const LightPrimitive& p, const PlanarView& view, const Vec3& to_point,
            LightSample& out) {
  out.distance = length(to_point);
  if (!(out.distance > 0)) return false;
  out.wi = to_point * (1 / out.distance);
  out.normal = Vec3(view.is_front ? p.normal : -p.normal);
  out.is_front = view.is_front;
  return out.pdf_solid_angle > 0 && std::isfinite(out.pdf_solid_angle);
}

// ---- rectangle ----

// Finishes a rectangle sample. from_foot, from_corner: the point relative to the receiver's foot
// and to vertex 0, in units of the piece's radius. Using the foot keeps a small height from being
// lost in a large lateral distance.
bool finish_rectangle(const LightPrimitive& p, const PlanarView& view, const Vec2& from_foot,
                      const Vec2& from_corner, LightSample& out) {
  const Vec2 local = from_corner * p.radius, lateral = from_foot * p.radius;
  out.point = p.vertices[0] + p.axis_x * local.x + p.axis_y * local.y;
  const Vec3 normal(view.is_front ? -p.normal : p.normal);
  return finish(p, view, p.axis_x * lateral.x + p.axis_y * lateral.y + normal * float(view.height),
                out);
}

bool sample_rectangle(const LightPrimitive& p, const PlanarView& view, const Vec3& x, const Vec2& u,
                      LightSample& out) {
  if (!view.is_far) {
    const auto single = rectangle_from<float>(p, x, view.height);
    if (single.solid_angle >= least_rectangle_sr) {
      out.pdf_solid_angle = 1 / single.solid_angle;
      Vec2 q;
      if (single.solid_angle >= least_single_precision_sr)
        q = single.sample(u);
      else
        q = Vec2(rectangle_from<double>(p, x, view.height).sample(Vec2d(u)));
      return finish_rectangle(p, view, q, {q.x - single.x0, q.y - single.y0}, out);
    }
  }
  const Vec2 local{u.x * p.size_x, u.y * p.size_y};
  const Vec3 offset = p.axis_x * local.x + p.axis_y * local.y;
  out.point = p.vertices[0] + offset;
  const Vec3 to_point = (p.vertices[0] - x) + offset;
  out.pdf_solid_angle = view.pdf_from_area(p, length(to_point));
  return finish(p, view, to_point, out);
}

float pdf_rectangle(const LightPrimitive& p, const PlanarView& view, const Vec3& x,
                    float distance) {
  if (!view.is_far) {
    const auto single = rectangle_from<float>(p, x, view.height);
    if (single.solid_angle >= least_rectangle_sr) return 1 / single.solid_angle;
  }
  return view.pdf_from_area(p, distance);
}

// ---- triangle, and polygon as a fan of triangles about vertex 0 ----

// Picks fan triangle i in proportion to weight(i) >= 0, and rescales u to it. Returns the sum of
// weights.
template <class Weight>
float pick_fan_triangle(const LightPrimitive& p, const Weight& weight, float& u, uint32_t& picked) {
  constexpr uint32_t kept = 16;
  float weights[kept];
  float total = 0;
  const uint32_t count = p.vertex_count - 2;
  for (uint32_t i = 0; i < count; ++i) {
    const float w = weight(i);
    if (i < kept) weights[i] = w;
    total += w;
  }
  float target = u * total;
  for (uint32_t i = 0; i < count; ++i) {
    const float w = i < kept ? weights[i] : weight(i);
    if (w > 0) {
      picked = i;
      u = std::min(target / w, one_minus_epsilon);
      if (target < w) break;
    }
    target -= w;
  }
  u = std::max(u, 0.0f);
  return total;
}

float fan_solid_angle(const LightPrimitive& p, const PlanarView& view, const Vec3& x) {
  float total = 0;
  for (uint32_t i = 0; i + 2 < p.vertex_count; ++i)
    total += wants_double(p, view) ? float(fan_triangle<double>(p, x, view.height, i).solid_angle)
                                   : fan_triangle<float>(p, x, view.height, i).solid_angle;
  return total;
}

bool finish_fan(const LightPrimitive& p, const PlanarView& view, uint32_t i,
                const Barycentric<float>& w, const Vec3& to_point, LightSample& out) {
  const Vec3 b = p.vertex(0);
  out.point = b + (p.vertex(i + 1) - b) * w.a + (p.vertex(i + 2) - b) * w.c;
  out.texture_uv = p.uvs[0] * w.b + p.uvs[1] * w.a + p.uvs[2] * w.c;
  return finish(p, view, to_point, out);
}

template <class T>
bool sample_fan_solid_angle(const LightPrimitive& p, const PlanarView& view, const Vec3& x, Vec2 u,
                            LightSample& out) {
  uint32_t i = 0;
  SphericalTriangle<T> t;
  if (p.vertex_count == 3) {
    t = fan_triangle<T>(p, x, view.height, 0);
    if (!(t.solid_angle > 0)) return false;
    out.pdf_solid_angle = 1 / float(t.solid_angle);
  } else if (p.vertex_count == 4) {
    t = fan_triangle<T>(p, x, view.height, 0);
    const SphericalTriangle<T> second = fan_triangle<T>(p, x, view.height, 1);
    const float total = float(t.solid_angle) + float(second.solid_angle);
    if (!(total > 0)) return false;
    out.pdf_solid_angle = 1 / total;
    const float target = u.x * total;
    i = target < float(t.solid_angle) || !(second.solid_angle > 0) ? 0 : 1;
    if (i == 1) t = second;
    u.x = (i == 0 ? target : target - (total - float(t.solid_angle))) / float(t.solid_angle);
    u.x = std::min(std::max(u.x, 0.0f), one_minus_epsilon);
  } else {
    const auto weight = [&](uint32_t k) {
      return float(fan_triangle<T>(p, x, view.height, k).solid_angle);
    };
    const float total = pick_fan_triangle(p, weight, u.x, i);
    if (!(total > 0)) return false;
    out.pdf_solid_angle = 1 / total;
    t = fan_triangle<T>(p, x, view.height, i);
  }
  const Barycentric<T> w = t.sample(Vec2T<T>(u));
  const Vec3T<T> to_point =
      t.a * (w.a * t.length_a) + t.b * (w.b * t.length_b) + t.c * (w.c * t.length_c);
  return finish_fan(p, view, i, {float(w.a), float(w.b), float(w.c)}, Vec3(to_point), out);
}

bool sample_fan(const LightPrimitive& p, const PlanarView& view, const Vec3& x, Vec2 u,
                LightSample& out) {
  if (!view.is_far) {
    return wants_double(p, view) ? sample_fan_solid_angle<double>(p, view, x, u, out)
                                 : sample_fan_solid_angle<float>(p, view, x, u, out);
  }
  uint32_t i = 0;
  if (p.vertex_count > 3)
    pick_fan_triangle(
        p, [&](uint32_t k) { return fan_area(p, k); }, u.x, i);
  const float radial = std::sqrt(u.y);
  const Barycentric<float> w{radial * (1 - u.x), 1 - radial, radial * u.x};
  const Vec3 b = p.vertex(0);
  const Vec3 to_point = (b - x) + (p.vertex(i + 1) - b) * w.a + (p.vertex(i + 2) - b) * w.c;
  out.pdf_solid_angle = view.pdf_from_area(p, length(to_point));
  return finish_fan(p, view, i, w, to_point, out);
}

float pdf_fan(const LightPrimitive& p, const PlanarView& view, const Vec3& x, float distance) {
  if (view.is_far) return view.pdf_from_area(p, distance);
  const float total = fan_solid_angle(p, view, x);
  return total > 0 ? 1 / total : 0;
}

// ---- disk ----

bool sample_disk(const LightPrimitive& p, const PlanarView& view, const Vec3& x, const Vec2& u,
                 LightSample& out) {
  if (view.is_far) {
    const Vec2 d = disk_from_square(u) * p.radius;
    const Vec3 offset = p.axis_x * d.x + p.axis_y * d.y;
    out.point = p.centroid + offset;
    const Vec3 to_point = (p.centroid - x) + offset;
    out.pdf_solid_angle = view.pdf_from_area(p, length(to_point));
    return finish(p, view, to_point, out);
  }
  const DiskView local(p, view, x);
  double pdf = 0;
  const Vec2d q = local.disk.sample(Vec2d(u), pdf);
  out.pdf_solid_angle = float(pdf);
  const double r = double(p.radius);
  out.point = Vec3(Vec3d(p.centroid) + local.a * (q.x * r) + local.b * (q.y * r));
  const Vec3d to_point =
      local.a * ((q.x - local.disk.rho) * r) + local.b * (q.y * r) - local.up * view.height;
  return finish(p, view, Vec3(to_point), out);
}

float pdf_disk(const LightPrimitive& p, const PlanarView& view, const Vec3& x, const Vec3& wi,
               float distance) {
  if (view.is_far) return view.pdf_from_area(p, distance);
  const DiskView local(p, view, x);
  const Vec3d d = Vec3d(wi) * (double(distance) / double(p.radius));
  return float(local.disk.pdf_solid_angle({dot(d, local.a) + local.disk.rho, dot(d, local.b)}));
}

// ---- sphere ----

bool sample_sphere(const LightPrimitive& p, const Vec3& x, const Vec2& u, LightSample& out) {
  const SphereView view(p, x);
  if (!view.is_visible) return false;
  out.is_front = view.is_front;
  if (view.is_inside) {
    out.wi = sphere_from_square(u);
    const Vec3d w(out.wi);
    const double along = dot(w, view.to_centre);
    const Vec3d miss = view.to_centre - w * along;  // from the chord's middle to the centre
    const double t = along + std::sqrt(std::max(0.0, 1 - length_squared(miss)));
    out.normal = Vec3(normalize(view.to_centre - w * t));
    out.distance = float(t) * p.radius;
    out.pdf_solid_angle = inv_pi_f / 4;
    out.point = p.centroid - out.normal * p.radius;
    return out.distance > 0;
  }
  const SphericalCap cap(view.distance);
  const Framed frame(view.to_centre / view.distance);
  const SphericalCap::Hit hit = cap.sample(Vec2d(u));
  out.wi = Vec3(frame.to_world(hit.wi));
  out.normal = Vec3(frame.to_world(hit.normal));
  out.distance = float(hit.t) * p.radius;
  out.point = p.centroid + out.normal * p.radius;
  out.pdf_solid_angle = float(cap.pdf_solid_angle());
  return out.distance > 0;
}

}  // namespace

bool sample(const LightPrimitive& p, const Vec3& x, const Vec2& u, LightSample& out) {
  if (p.shape == PrimitiveShape::sphere) {
    out.texture_uv = {};
    return sample_sphere(p, x, u, out);
  }
  const PlanarView view(p, x);
  if (!view.is_visible) return false;
  if (p.shape == PrimitiveShape::rectangle || p.shape == PrimitiveShape::disk) {
    out.texture_uv = {};
    return p.shape == PrimitiveShape::disk ? sample_disk(p, view, x, u, out)
                                           : sample_rectangle(p, view, x, u, out);
  }
  return sample_fan(p, view, x, u, out);
}

namespace {

// Samples the near rectangles of a batch, vectorized over rectangles. The arrays are parameters
// because compilers honour __restrict only there.
TROFFER_MULTIVERSION
void sample_rectangles(size_t n, const float* __restrict corner_x, const float* __restrict corner_y,
                       const float* __restrict size_x, const float* __restrict size_y,
                       const float* __restrict height, const float* __restrict u,
                       const float* __restrict v, float* __restrict x, float* __restrict y,
                       float* __restrict solid_angle) {
  for (size_t i = 0; i < n; ++i) {
    const SphericalRectangle<float> r(corner_x[i], corner_x[i] + size_x[i], corner_y[i],
                                      corner_y[i] + size_y[i], height[i]);
    const Vec2 q = r.sample(Vec2(u[i], v[i]));
    x[i] = q.x;
    y[i] = q.y;
    solid_angle[i] = r.solid_angle;
  }
}

}  // namespace

void sample_many(const LightPrimitives& all, size_t n, const uint32_t* primitives,
                 const Vec3* receivers, const float* u, const float* v, LightSample* out,
                 uint8_t* is_valid, LightSampleScratch& s) {
  for (auto* a : {&s.corner_x, &s.corner_y, &s.size_x, &s.size_y, &s.height, &s.u, &s.v, &s.x, &s.y,
                  &s.solid_angle})
    a->resize(n);
  s.index.resize(n);
  size_t near = 0;
  // Prefetch distance, because any piece of a large mesh may come next.
  constexpr size_t ahead = 8;
  for (size_t i = 0; i < n; ++i) {
    if (i + ahead < n) prefetch_object(all[primitives[i + ahead]]);
    const LightPrimitive& p = all[primitives[i]];
    if (p.shape == PrimitiveShape::rectangle) {
      const PlanarView view(p, receivers[i]);
      is_valid[i] = view.is_visible;
      if (!view.is_visible) continue;
      if (!view.is_far) {
        const float scale = 1 / p.radius;
        const Vec3 corner = p.vertices[0] - receivers[i];
        s.index[near] = uint32_t(i);
        s.corner_x[near] = dot(corner, p.axis_x) * scale;
        s.corner_y[near] = dot(corner, p.axis_y) * scale;
        s.size_x[near] = p.size_x * scale;
        s.size_y[near] = p.size_y * scale;
        s.height[near] = float(view.height) * scale;
        s.u[near] = u[i];
        s.v[near] = v[i];
        ++near;
        continue;
      }
    }
    is_valid[i] = p.has_surface() && sample(p, receivers[i], {u[i], v[i]}, out[i]);
  }
  sample_rectangles(near, s.corner_x.data(), s.corner_y.data(), s.size_x.data(), s.size_y.data(),
                    s.height.data(), s.u.data(), s.v.data(), s.x.data(), s.y.data(),
                    s.solid_angle.data());
  for (size_t k = 0; k < near; ++k) {
    const size_t i = s.index[k];
    const LightPrimitive& p = all[primitives[i]];
    if (!(s.solid_angle[k] >= least_single_precision_sr)) {
      is_valid[i] = sample(p, receivers[i], {u[i], v[i]}, out[i]);
      continue;
    }
    out[i].texture_uv = {};
    out[i].pdf_solid_angle = 1 / s.solid_angle[k];
    is_valid[i] = finish_rectangle(p, PlanarView(p, receivers[i]), {s.x[k], s.y[k]},
                                   {s.x[k] - s.corner_x[k], s.y[k] - s.corner_y[k]}, out[i]);
  }
}

float pdf_solid_angle(const LightPrimitive& p, const Vec3& x, const Vec3& wi, float distance) {
  if (p.shape == PrimitiveShape::sphere) {
    const SphereView view(p, x);
    if (!view.is_visible || !view.can_sample(wi, double(distance) / double(p.radius))) return 0;
    return view.is_inside ? inv_pi_f / 4 : float(SphericalCap(view.distance).pdf_solid_angle());
  }
  const PlanarView view(p, x);
  if (!view.is_visible) return 0;
  if (p.shape == PrimitiveShape::rectangle) return pdf_rectangle(p, view, x, distance);
  if (p.shape == PrimitiveShape::disk) return pdf_disk(p, view, x, wi, distance);
  return pdf_fan(p, view, x, distance);
}

}  // namespace troffer
