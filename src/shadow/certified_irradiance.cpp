#include "shadow/certified_irradiance.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/simd.h"
#include "base/units.h"
#include "emitter/arctangent.h"
#include "emitter/irradiance.h"

namespace troffer {

namespace {

constexpr size_t block = 16;

struct Block {
  alignas(64) double x[block], y[block], z[block], nx[block], ny[block], nz[block];
  alignas(64) double sum[block], least[block];
};

// Lambert's sum of a polygon that stands above the horizon [1]; least: the lowest corner's height.
TROFFER_MULTIVERSION
void lambert_sums(const double* __restrict corners, int n, const double* __restrict x,
                  const double* __restrict y, const double* __restrict z,
                  const double* __restrict nx, const double* __restrict ny,
                  const double* __restrict nz, double* __restrict sum, double* __restrict least) {
  for (size_t i = 0; i < block; ++i) {
    sum[i] = 0;
    least[i] = 1e300;
  }
  for (int e = 0; e < n; ++e) {
    const double* a = corners + 3 * e;
    const double* b = corners + 3 * (e + 1 == n ? 0 : e + 1);
    const double ex = b[0] - a[0], ey = b[1] - a[1], ez = b[2] - a[2];
    const double ax = a[0], ay = a[1], az = a[2];
    for (size_t i = 0; i < block; ++i) {
      const double vx = ax - x[i], vy = ay - y[i], vz = az - z[i];
      const double cx = vy * ez - vz * ey, cy = vz * ex - vx * ez, cz = vx * ey - vy * ex;
      const double sine2 = cx * cx + cy * cy + cz * cz;
      const double sine = std::sqrt(sine2);
      const double cosine = vx * (vx + ex) + vy * (vy + ey) + vz * (vz + ez);
      const double along = nx[i] * cx + ny[i] * cy + nz[i] * cz;
      const double safe = sine > 1e-300 ? sine : 1e-300;
      sum[i] += along / safe * upper_angle(sine, cosine);
      const double height = nx[i] * vx + ny[i] * vy + nz[i] * vz;
      least[i] = least[i] < height ? least[i] : height;
    }
  }
}

}  // namespace

void unoccluded_irradiance(std::span<const Vec3d> outline, const Vec3d& normal, size_t n,
                           const Vec3* positions, const Vec3* normals, float* out) {
  const int corners = int(std::min<size_t>(outline.size(), 8));
  double flat[24];
  for (int i = 0; i < corners; ++i)
    for (size_t a = 0; a < 3; ++a) flat[size_t(3 * i) + a] = outline[size_t(i)][a];
  const double level = dot(normal, outline[0]);
  Block b;
  for (size_t first = 0; first < n; first += block) {
    const size_t count = std::min(block, n - first);
    for (size_t i = 0; i < block; ++i) {
      const size_t at = first + std::min(i, count - 1);
      b.x[i] = double(positions[at].x);
      b.y[i] = double(positions[at].y);
      b.z[i] = double(positions[at].z);
      b.nx[i] = double(normals[at].x);
      b.ny[i] = double(normals[at].y);
      b.nz[i] = double(normals[at].z);
    }
    lambert_sums(flat, corners, b.x, b.y, b.z, b.nx, b.ny, b.nz, b.sum, b.least);
    for (size_t i = 0; i < count; ++i) {
      const Vec3d x(positions[first + i]);
      double value = 0;
      if (dot(normal, x) > level) {
        value = b.least[i] >= 0
                    ? std::min(0.5 * std::abs(b.sum[i]), pi)
                    : polygon_irradiance(outline, x, Vec3d(normals[first + i]), Sides::both);
      }
      out[first + i] = float(value);
    }
  }
}

}  // namespace troffer
