#include "light/rectangle_receivers.h"

#include <cmath>

#include "base/simd.h"
#include "light/receiver_view.h"

namespace troffer {

namespace {

// A rectangle in single precision. Lengths are in units of its radius, except the corner.
struct FlatRectangle {
  Vec3 corner, axis_x, axis_y, normal;
  float size_x = 0, size_y = 0, per_radius = 0;
  float back = 0;  // 1: the back emits too; else 0

  explicit FlatRectangle(const LightPrimitive& p)
      : corner(p.vertices[0]),
        axis_x(p.axis_x),
        axis_y(p.axis_y),
        normal(Vec3(p.normal)),
        size_x(p.size_x / p.radius),
        size_y(p.size_y / p.radius),
        per_radius(1 / p.radius),
        back(p.is_two_sided ? 1.0f : 0.0f) {}
};

TROFFER_ALWAYS_INLINE float dot_of(float ax, float ay, float az, const Vec3& b) {
  return ax * b.x + ay * b.y + az * b.z;
}

// Branch-free, so that the loop over receivers vectorizes.
TROFFER_ALWAYS_INLINE void point_for(const FlatRectangle& p, const Vec3& at, const Vec3& shading,
                                     const Vec3& normal, float u, float v, float& cosine,
                                     float& inverse_pdf) {
  constexpr float least_sine = 1e-3f, tiny = std::numeric_limits<float>::min();
  const Vec3 c{(p.corner.x - at.x) * p.per_radius, (p.corner.y - at.y) * p.per_radius,
               (p.corner.z - at.z) * p.per_radius};
  const float x0 = dot_of(c.x, c.y, c.z, p.axis_x), y0 = dot_of(c.x, c.y, c.z, p.axis_y);
  const float height = -dot_of(c.x, c.y, c.z, p.normal), z = std::abs(height);
  const float mx = x0 + 0.5f * p.size_x, my = y0 + 0.5f * p.size_y;
  const float from_centre2 = mx * mx + my * my + z * z;
  const bool is_far = from_centre2 > far_in_radii * far_in_radii;

  const SphericalRectangle<float> r(x0, x0 + p.size_x, y0, y0 + p.size_y, std::max(z, 1e-6f));
  const Vec2 near = r.sample(Vec2(u, v));
  const float qx = is_far ? x0 + u * p.size_x : near.x, qy = is_far ? y0 + v * p.size_y : near.y;
  const float d2 = std::max(qx * qx + qy * qy + z * z, tiny), per_d = 1 / std::sqrt(d2);
  const float by_area = z * p.size_x * p.size_y * (per_d * per_d * per_d);

  const float wx = qx * p.axis_x.x + qy * p.axis_y.x - height * p.normal.x;
  const float wy = qx * p.axis_x.y + qy * p.axis_y.y - height * p.normal.y;
  const float wz = qx * p.axis_x.z + qy * p.axis_y.z - height * p.normal.z;
  const float by_shading = dot_of(wx, wy, wz, shading) * per_d;
  const float by_normal = dot_of(wx, wy, wz, normal);
  cosine = by_shading * by_normal > 0 ? by_shading : 0;
  const bool is_grazing = z * z < least_sine * least_sine * std::max(from_centre2, 1.0f);
  const bool is_small = !is_far & (r.solid_angle < least_single_precision_sr);
  const float lit = (height > 0 ? 1.0f : p.back) * (is_far ? by_area : r.solid_angle);
  inverse_pdf = is_grazing | is_small ? -1 : lit;
}

// The arrays are parameters because compilers honour __restrict only there.
TROFFER_MULTIVERSION
void points_for(const FlatRectangle& rectangle, size_t n, const float* __restrict x,
                const float* __restrict y, const float* __restrict z, const float* __restrict sx,
                const float* __restrict sy, const float* __restrict sz, const float* __restrict nx,
                const float* __restrict ny, const float* __restrict nz, const float* __restrict u,
                const float* __restrict v, float* __restrict cosine,
                float* __restrict inverse_pdf) {
  const FlatRectangle p = rectangle;
  for (size_t i = 0; i < n; ++i)
    point_for(p, {x[i], y[i], z[i]}, {sx[i], sy[i], sz[i]}, {nx[i], ny[i], nz[i]}, u[i], v[i],
              cosine[i], inverse_pdf[i]);
}

}  // namespace

void points_of_rectangle(const LightPrimitive& p, const SurfaceArrays& r, const float* u,
                         const float* v, float* cosine, float* inverse_pdf) {
  points_for(FlatRectangle(p), r.n, r.x, r.y, r.z, r.shading_x, r.shading_y, r.shading_z,
             r.normal_x, r.normal_y, r.normal_z, u, v, cosine, inverse_pdf);
}

}  // namespace troffer
