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
      // with the edge, not with the other end: accurate where both are nearly parallel
      const double cx = vy * ez - vz * ey, cy = vz * ex - vx * ez, cz = vx * ey - vy * ex;
      const double sine = std::sqrt(cx * cx + cy * cy + cz * cz);
      const double cosine = vx * (vx + ex) + vy * (vy + ey) + vz * (vz + ez);
      const double along = nx[i] * cx + ny[i] * cy + nz[i] * cz;
      const double safe = sine > 1e-300 ? sine : 1e-300;
      sum[i] += along * (upper_angle(sine, cosine) / safe);
      const double height = nx[i] * vx + ny[i] * vy + nz[i] * vz;
      least[i] = least[i] < height ? least[i] : height;
    }
  }
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

void ReceiverArrays::clear() {
  for (size_t a = 0; a < 3; ++a) {
    position[a].clear();
    normal[a].clear();
  }
  horizons.clear();
  size = 0;
}

void ReceiverArrays::add(const Vec3& p, const Vec3& n) {
  for (size_t a = 0; a < 3; ++a) {
    position[a].push_back(double(p[a]));
    normal[a].push_back(double(n[a]));
  }
  ++size;
}

void ReceiverArrays::finish() {
  for (size_t a = 0; a < 3; ++a)
    for (auto* v : {&position[a], &normal[a]})
      while (v->size() % block != 0) v->push_back(v->back());
}

void unoccluded_irradiance(std::span<const Vec3d> outline, const Vec3d& plane_normal,
                           const ReceiverArrays& receivers, float* out) {
  outline = outline.first(std::min(outline.size(), most_corners));
  const int corners = int(outline.size());
  double flat[3 * most_corners], sum[block], least[block];
  for (int i = 0; i < corners; ++i)
    for (size_t a = 0; a < 3; ++a) flat[size_t(3 * i) + a] = outline[size_t(i)][a];
  const double level = dot(plane_normal, outline[0]);
  const auto& p = receivers.position;
  const auto& n = receivers.normal;
  for (size_t first = 0; first < receivers.size; first += block) {
    lambert_sums(flat, corners, p[0].data() + first, p[1].data() + first, p[2].data() + first,
                 n[0].data() + first, n[1].data() + first, n[2].data() + first, sum, least);
    const size_t count = std::min(block, receivers.size - first);
    for (size_t i = 0; i < count; ++i) {
      const Vec3d x = receivers.position_at(first + i);
      double value = 0;
      if (dot(plane_normal, x) > level) {
        if (!receivers.horizons.empty() &&
            lowest_corner(outline, x, Vec3d(receivers.horizons[first + i])) < 0)
          value = clipped_irradiance(outline, x, receivers.normal_at(first + i),
                                     Vec3d(receivers.horizons[first + i]));
        else if (least[i] < 0)
          value = polygon_irradiance(outline, x, receivers.normal_at(first + i), Sides::both);
        else
          value = std::min(0.5 * std::abs(sum[i]), pi);
      }
      out[first + i] = float(value);
    }
  }
}

}  // namespace troffer
