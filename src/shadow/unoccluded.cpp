#include "shadow/unoccluded.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/simd.h"
#include "base/units.h"
#include "light/arctangent.h"
#include "light/irradiance.h"
#include "light/polygon.h"

namespace troffer {

namespace {

constexpr size_t block = 16;

// Lambert's sum of a polygon that stands above the horizon [1], from receivers relative to its
// first corner; least: the lowest corner's height.
template <class T>
TROFFER_ALWAYS_INLINE void add_lambert_edges(const T* __restrict corners, int n,
                                             const T* __restrict x, const T* __restrict y,
                                             const T* __restrict z, const T* __restrict nx,
                                             const T* __restrict ny, const T* __restrict nz,
                                             T* __restrict sum, T* __restrict least) {
  for (size_t i = 0; i < block; ++i) {
    sum[i] = 0;
    least[i] = std::numeric_limits<T>::max();
  }
  for (int e = 0; e < n; ++e) {
    const T* a = corners + 3 * e;
    const T* b = corners + 3 * (e + 1 == n ? 0 : e + 1);
    const T ex = b[0] - a[0], ey = b[1] - a[1], ez = b[2] - a[2];
    const T ax = a[0], ay = a[1], az = a[2];
    for (size_t i = 0; i < block; ++i) {
      const T vx = ax - x[i], vy = ay - y[i], vz = az - z[i];
      // with the edge, not with the other end: accurate where both are nearly parallel
      const T cx = vy * ez - vz * ey, cy = vz * ex - vx * ez, cz = vx * ey - vy * ex;
      const T sine = std::sqrt(cx * cx + cy * cy + cz * cz);
      const T cosine = vx * (vx + ex) + vy * (vy + ey) + vz * (vz + ez);
      const T along = nx[i] * cx + ny[i] * cy + nz[i] * cz;
      const T safe = sine > T(1e-30) ? sine : T(1e-30);
      sum[i] += along * (upper_angle(sine, cosine) / safe);
      const T height = nx[i] * vx + ny[i] * vy + nz[i] * vz;
      least[i] = least[i] < height ? least[i] : height;
    }
  }
}

TROFFER_MULTIVERSION
void lambert_double(const double* __restrict corners, int n, const double* __restrict x,
                    const double* __restrict y, const double* __restrict z,
                    const double* __restrict nx, const double* __restrict ny,
                    const double* __restrict nz, double* __restrict sum, double* __restrict least) {
  add_lambert_edges(corners, n, x, y, z, nx, ny, nz, sum, least);
}

TROFFER_MULTIVERSION
void lambert_float(const float* __restrict corners, int n, const float* __restrict x,
                   const float* __restrict y, const float* __restrict z, const float* __restrict nx,
                   const float* __restrict ny, const float* __restrict nz, float* __restrict sum,
                   float* __restrict least) {
  add_lambert_edges(corners, n, x, y, z, nx, ny, nz, sum, least);
}

// A block in single precision. Differences that cancel are taken in double.
struct FloatBlock {
  alignas(64) float x[block], y[block], z[block], nx[block], ny[block], nz[block];
  alignas(64) float sum[block], least[block];
};

TROFFER_MULTIVERSION
void to_floats(const double* __restrict from, double origin, float* __restrict to) {
  for (size_t i = 0; i < block; ++i) to[i] = float(from[i] - origin);
}

constexpr size_t most_corners = 16;

// Clipped to the horizon of unit normal h through x first.
double clipped_irradiance(std::span<const Vec3d> outline, const Vec3d& x, const Vec3d& n,
                          const Vec3d& h) {
  std::array<Vec3d, 2 * most_corners> kept;
  size_t count = 0;
  for (size_t i = 0; i < outline.size(); ++i) {
    const Vec3d &p = outline[i], &q = outline[(i + 1) % outline.size()];
    const double hp = dot(h, p - x), hq = dot(h, q - x);
    if (hp >= 0) kept[count++] = p;
    if ((hp < 0) != (hq < 0)) kept[count++] = p + (q - p) * (hp / (hp - hq));
  }
  return polygon_irradiance({kept.data(), count}, x, n, Sides::both);
}

double lowest_corner(std::span<const Vec3d> outline, const Vec3d& x, const Vec3d& h) {
  double least = dot(h, outline[0] - x);
  for (const Vec3d& c : outline) least = std::min(least, dot(h, c - x));
  return least;
}

}  // namespace

void ReceiverArrays::assign(size_t n) {
  size = n;
  const size_t whole = (n + block - 1) / block * block;
  for (size_t a = 0; a < 3; ++a) {
    position[a].resize(whole);
    normal[a].resize(whole);
  }
  horizons.clear();
}

void ReceiverArrays::set(size_t i, const Vec3& p, const Vec3& n) {
  // the last one also fills its block up
  const size_t end = i + 1 == size ? position[0].size() : i + 1;
  for (size_t a = 0; a < 3; ++a)
    for (size_t k = i; k < end; ++k) {
      position[a][k] = double(p[a]);
      normal[a][k] = double(n[a]);
    }
}

namespace {

// What is common to all receivers of a call.
struct PolygonSums {
  std::span<const Vec3d> outline;
  double corners[3 * most_corners];  // relative to the first one
  float float_corners[3 * most_corners];
  double near2 = 0;  // square of the distance from which on sums are taken in double

  explicit PolygonSums(std::span<const Vec3d> polygon) : outline(polygon) {
    double diameter2 = 0;
    for (size_t i = 0; i < outline.size(); ++i) {
      const Vec3d d = outline[i] - outline[0];
      diameter2 = std::max(diameter2, length_squared(d));
      for (size_t a = 0; a < 3; ++a) {
        corners[3 * i + a] = d[a];
        float_corners[3 * i + a] = float(d[a]);
      }
    }
    near2 = 100 * diameter2;
  }

  // sum, least: of the block that starts at `first`.
  void block_sums(const ReceiverArrays& r, size_t first, double* sum, double* least) const {
    const Vec3d& o = outline[0];
    const int n = int(outline.size());
    const auto& p = r.position;
    const auto& nn = r.normal;
    // Terms of the size of the polygon's angle d add up to its square: from single precision
    // remains a relative error of about 1e-6 / d.
    if (length_squared(r.position_at(first) - o) < near2 &&
        length_squared(r.position_at(first + block - 1) - o) < near2) {
      FloatBlock b;
      to_floats(p[0].data() + first, o.x, b.x);
      to_floats(p[1].data() + first, o.y, b.y);
      to_floats(p[2].data() + first, o.z, b.z);
      to_floats(nn[0].data() + first, 0, b.nx);
      to_floats(nn[1].data() + first, 0, b.ny);
      to_floats(nn[2].data() + first, 0, b.nz);
      lambert_float(float_corners, n, b.x, b.y, b.z, b.nx, b.ny, b.nz, b.sum, b.least);
      for (size_t i = 0; i < block; ++i) {
        sum[i] = double(b.sum[i]);
        least[i] = double(b.least[i]);
      }
      return;
    }
    alignas(64) double at[3][block];
    for (size_t a = 0; a < 3; ++a)
      for (size_t i = 0; i < block; ++i) at[a][i] = p[a][first + i] - o[a];
    lambert_double(corners, n, at[0], at[1], at[2], nn[0].data() + first, nn[1].data() + first,
                   nn[2].data() + first, sum, least);
  }
};

}  // namespace

void unoccluded_irradiance(std::span<const Vec3d> outline, const Vec3d& plane_normal,
                           const ReceiverArrays& receivers, float* out) {
  outline = outline.first(std::min(outline.size(), most_corners));
  const PolygonSums sums(outline);
  alignas(64) double sum[block], least[block];
  const double level = dot(plane_normal, outline[0]);
  for (size_t first = 0; first < receivers.size; first += block) {
    sums.block_sums(receivers, first, sum, least);
    const size_t count = std::min(block, receivers.size - first);
    for (size_t i = 0; i < count; ++i) {
      const Vec3d x = receivers.position_at(first + i);
      double value = 0;
      if (dot(plane_normal, x) > level + plane_rounding(x, outline[0])) {
        if (!receivers.horizons.empty() &&
            lowest_corner(outline, x, Vec3d(receivers.horizons[first + i])) < 0)
          value = clipped_irradiance(outline, x, receivers.normal_at(first + i),
                                     Vec3d(receivers.horizons[first + i]));
        else if (least[i] <= 0)
          value = polygon_irradiance(outline, x, receivers.normal_at(first + i), Sides::both);
        else
          value = std::min(0.5 * std::abs(sum[i]), pi);
      }
      out[first + i] = float(value);
    }
  }
}

}  // namespace troffer
