#include "light/light_points.h"

#include <algorithm>
#include <cmath>

#include "base/simd.h"
#include "light/light_sample.h"
#include "light/receiver_view.h"

namespace troffer {

namespace {

// Points uniform in solid angle. Lengths in units of the piece's radius.
TROFFER_MULTIVERSION
void near_points(const SphericalRectangle<float>& rectangle, size_t n, const float* __restrict u,
                 const float* __restrict v, const Vec3& a, const Vec3& b, const Vec3& h,
                 float* __restrict x, float* __restrict y, float* __restrict z) {
  const SphericalRectangle<float> r = rectangle;
  for (size_t i = 0; i < n; ++i) {
    const Vec2 q = r.sample(Vec2(u[i], v[i]));
    x[i] = a.x * q.x + b.x * q.y + h.x;
    y[i] = a.y * q.x + b.y * q.y + h.y;
    z[i] = a.z * q.x + b.z * q.y + h.z;
  }
}

// Points uniform in area: corner + u a + v b. height_area: height of the receiver over the plane,
// times the area.
TROFFER_MULTIVERSION
void far_points(size_t n, const float* __restrict u, const float* __restrict v, const Vec3& corner,
                const Vec3& a, const Vec3& b, float height_area, float* __restrict x,
                float* __restrict y, float* __restrict z, float* __restrict inverse_pdf) {
  for (size_t i = 0; i < n; ++i) {
    x[i] = corner.x + (a.x * u[i] + b.x * v[i]);
    y[i] = corner.y + (a.y * u[i] + b.y * v[i]);
    z[i] = corner.z + (a.z * u[i] + b.z * v[i]);
    const float d2 = x[i] * x[i] + y[i] * y[i] + z[i] * z[i];
    inverse_pdf[i] = height_area / (d2 * std::sqrt(d2));
  }
}

// Returns false for a near rectangle that is too small in solid angle for single precision.
bool sample_rectangle_points(const LightPrimitive& p, const PlanarView& view, const Vec3& receiver,
                             size_t n, const float* u, const float* v, LightPoints& out) {
  const Vec3 normal(view.is_front ? p.normal : -p.normal);
  if (view.is_far) {
    far_points(n, u, v, p.vertices[0] - receiver, p.axis_x * p.size_x, p.axis_y * p.size_y,
               float(view.height * double(p.area)), out.x.data(), out.y.data(), out.z.data(),
               out.inverse_pdf.data());
  } else {
    const auto r = rectangle_from<float>(p, receiver, view.height);
    if (!(r.solid_angle >= least_single_precision_sr)) return false;
    near_points(r, n, u, v, p.axis_x * p.radius, p.axis_y * p.radius, normal * -float(view.height),
                out.x.data(), out.y.data(), out.z.data());
    std::fill_n(out.inverse_pdf.begin(), n, r.solid_angle);
  }
  std::fill_n(out.nx.begin(), n, normal.x);
  std::fill_n(out.ny.begin(), n, normal.y);
  std::fill_n(out.nz.begin(), n, normal.z);
  return true;
}

}  // namespace

void LightPoints::resize(size_t n) {
  for (auto* a : {&x, &y, &z, &nx, &ny, &nz, &inverse_pdf}) a->resize(n);
}

void sample_point(const LightPrimitive& p, const Vec3& receiver, float u, float v, size_t i,
                  LightPoints& out) {
  LightSample s;
  if (!sample(p, receiver, {u, v}, s)) {
    out.inverse_pdf[i] = 0;
    out.x[i] = out.y[i] = out.z[i] = 0;
    return;
  }
  const Vec3 to_point = s.wi * s.distance;
  out.x[i] = to_point.x;
  out.y[i] = to_point.y;
  out.z[i] = to_point.z;
  out.nx[i] = s.normal.x;
  out.ny[i] = s.normal.y;
  out.nz[i] = s.normal.z;
  out.inverse_pdf[i] = 1 / s.pdf_solid_angle;
}

bool sample_points(const LightPrimitive& p, const Vec3& receiver, size_t n, const float* u,
                   const float* v, LightPoints& out) {
  out.resize(n);
  if (p.shape != PrimitiveShape::sphere) {
    const PlanarView view(p, receiver);
    if (!view.is_visible) return false;
    if (p.shape == PrimitiveShape::rectangle &&
        sample_rectangle_points(p, view, receiver, n, u, v, out))
      return true;
  }
  for (size_t i = 0; i < n; ++i) sample_point(p, receiver, u[i], v[i], i, out);
  return true;
}

bool is_below_horizon(const LightPrimitive& p, const Vec3& receiver, const Vec3& n) {
  const float above = dot(p.centroid - receiver, n) + p.radius;
  const float slack = 1e-5f * (length(p.centroid - receiver) + p.radius);
  if (above <= -slack) return true;
  if (p.vertex_count == 0 || p.vertex_count > 4) return false;
  for (uint32_t i = 0; i < p.vertex_count; ++i)
    if (dot(p.vertices[i] - receiver, n) > -slack) return false;
  return true;
}

}  // namespace troffer
