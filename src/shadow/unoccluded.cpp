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
#include "shadow/coverage_mask.h"
#include "shadow/vector_lanes.h"

namespace troffer {

namespace {

// Sums over the edges of a polygon for a block of receivers with all corners above the horizon.
template <class T>
struct alignas(64) BlockSums {
  T sum[vector_lanes];     // Lambert's sum [1]
  T least[vector_lanes];   // height of the lowest corner
  T angles[vector_lanes];  // edge length × angle / |v × e|, summed: see is_exact
};

// Receivers relative to the polygon's first corner.
template <class T>
struct alignas(64) BlockReceivers {
  T x[vector_lanes], y[vector_lanes], z[vector_lanes], nx[vector_lanes], ny[vector_lanes],
      nz[vector_lanes];
};

template <class T>
TROFFER_ALWAYS_INLINE void add_lambert_edges(const T* __restrict corners, const T* __restrict sizes,
                                             int n, const BlockReceivers<T>& __restrict r,
                                             BlockSums<T>& __restrict out) {
  for (size_t i = 0; i < vector_lanes; ++i) {
    out.sum[i] = out.angles[i] = 0;
    out.least[i] = std::numeric_limits<T>::max();
  }
  for (int e = 0; e < n; ++e) {
    const T* a = corners + 3 * e;
    const T* b = corners + 3 * (e + 1 == n ? 0 : e + 1);
    const T ex = b[0] - a[0], ey = b[1] - a[1], ez = b[2] - a[2];
    const T ax = a[0], ay = a[1], az = a[2], size = sizes[e];
    for (size_t i = 0; i < vector_lanes; ++i) {
      const T vx = ax - r.x[i], vy = ay - r.y[i], vz = az - r.z[i];
      // cross product with the edge, not with the other end: accurate if both are nearly parallel
      const T cx = vy * ez - vz * ey, cy = vz * ex - vx * ez, cz = vx * ey - vy * ex;
      const T sine = std::sqrt(cx * cx + cy * cy + cz * cz);
      const T cosine = vx * (vx + ex) + vy * (vy + ey) + vz * (vz + ez);
      const T along = r.nx[i] * cx + r.ny[i] * cy + r.nz[i] * cz;
      const T safe = sine > T(1e-30) ? sine : T(1e-30);
      const T ratio = upper_angle(sine, cosine) / safe;
      out.sum[i] += along * ratio;
      out.angles[i] += size * ratio;
      const T height = r.nx[i] * vx + r.ny[i] * vy + r.nz[i] * vz;
      out.least[i] = out.least[i] < height ? out.least[i] : height;
    }
  }
}

TROFFER_MULTIVERSION
void lambert_double(const double* __restrict corners, const double* __restrict sizes, int n,
                    const BlockReceivers<double>& __restrict r, BlockSums<double>& __restrict out) {
  add_lambert_edges(corners, sizes, n, r, out);
}

TROFFER_MULTIVERSION
void lambert_float(const float* __restrict corners, const float* __restrict sizes, int n,
                   const BlockReceivers<float>& __restrict r, BlockSums<float>& __restrict out) {
  add_lambert_edges(corners, sizes, n, r, out);
}

// Subtracts in double precision, because the difference may cancel.
TROFFER_MULTIVERSION
void to_floats(const double* __restrict from, double origin, float* __restrict to) {
  for (size_t i = 0; i < vector_lanes; ++i) to[i] = float(from[i] - origin);
}
TROFFER_MULTIVERSION
void to_doubles(const double* __restrict from, double origin, double* __restrict to) {
  for (size_t i = 0; i < vector_lanes; ++i) to[i] = from[i] - origin;
}

// Returns the irradiance of the polygon clipped to the horizon with unit normal h. Coordinates are
// relative to x, since crossings far from the origin would lose digits.
double clipped_irradiance(std::span<const Vec3d> outline, const Vec3d& x, const Vec3d& n,
                          const Vec3d& h) {
  std::array<Vec3d, 2 * most_source_corners> kept;
  size_t count = 0;
  for (size_t i = 0; i < outline.size(); ++i) {
    const Vec3d p = outline[i] - x, q = outline[(i + 1) % outline.size()] - x;
    const double hp = dot(h, p), hq = dot(h, q);
    if (hp >= 0) kept[count++] = p;
    if ((hp < 0) != (hq < 0)) kept[count++] = p + (q - p) * (hp / (hp - hq));
  }
  return polygon_irradiance({kept.data(), count}, Vec3d(), n, Sides::both);
}

double lowest_corner(std::span<const Vec3d> outline, const Vec3d& x, const Vec3d& h) {
  double least = dot(h, outline[0] - x);
  for (const Vec3d& c : outline) least = std::min(least, dot(h, c - x));
  return least;
}

}  // namespace

void ReceiverArrays::assign(size_t n) {
  size = n;
  const size_t whole = (n + vector_lanes - 1) / vector_lanes * vector_lanes;
  for (size_t a = 0; a < 3; ++a) {
    position[a].resize(whole);
    normal[a].resize(whole);
  }
  horizons.clear();
}

void ReceiverArrays::set(size_t i, const Vec3& p, const Vec3& n) {
  // the last receiver also fills up its block
  const size_t end = i + 1 == size ? position[0].size() : i + 1;
  for (size_t a = 0; a < 3; ++a)
    for (size_t k = i; k < end; ++k) {
      position[a][k] = double(p[a]);
      normal[a][k] = double(n[a]);
    }
}

namespace {

// The polygon and a block of receivers in one precision.
template <class T>
struct Lambert {
  T corners[3 * most_source_corners];  // relative to the first one
  T sizes[most_source_corners];        // lengths of edges
  BlockReceivers<T> receivers;
  BlockSums<T> sums;

  void set_polygon(std::span<const Vec3d> outline) {
    for (size_t i = 0; i < outline.size(); ++i) {
      const Vec3d d = outline[i] - outline[0];
      sizes[i] = T(length(outline[i + 1 == outline.size() ? 0 : i + 1] - outline[i]));
      for (size_t a = 0; a < 3; ++a) corners[3 * i + a] = T(d[a]);
    }
  }
  void set_receivers(void (*convert)(const double*, double, T*), const ReceiverArrays& from,
                     size_t first, const Vec3d& origin) {
    convert(from.position[0].data() + first, origin.x, receivers.x);
    convert(from.position[1].data() + first, origin.y, receivers.y);
    convert(from.position[2].data() + first, origin.z, receivers.z);
    convert(from.normal[0].data() + first, 0, receivers.nx);
    convert(from.normal[1].data() + first, 0, receivers.ny);
    convert(from.normal[2].data() + first, 0, receivers.nz);
  }
};

// Lambert's sums of one polygon, block by block.
class PolygonSums {
 public:
  explicit PolygonSums(std::span<const Vec3d> outline) : outline_(outline) {
    double diameter2 = 0;
    for (const Vec3d& c : outline) diameter2 = std::max(diameter2, length_squared(c - outline[0]));
    diameter_ = std::sqrt(diameter2);
    single_.set_polygon(outline);
    double_.set_polygon(outline);
  }

  // Starts a block, in single precision if that may be exact enough.
  void begin_block(const ReceiverArrays& receivers, size_t first) {
    receivers_ = &receivers;
    first_ = first;
    is_double_ = false;
    // Terms of the size of the polygon's angle d add up to d². Single precision leaves a relative
    // error of about 1e-6 / d.
    const double near2 = 100 * sqr(diameter_);
    if (!(length_squared(receivers.position_at(first) - outline_[0]) < near2 &&
          length_squared(receivers.position_at(first + vector_lanes - 1) - outline_[0]) < near2))
      return to_double();
    single_.set_receivers(to_floats, receivers, first, outline_[0]);
    lambert_float(single_.corners, single_.sizes, int(outline_.size()), single_.receivers,
                  single_.sums);
  }

  bool is_cut(size_t i) const {
    return is_double_ ? double_.sums.least[i] <= 0 : single_.sums.least[i] <= 0;
  }

  // Returns Lambert's sum for receiver i of the block.
  double sum(size_t i) {
    if (!is_double_) {
      if (is_exact(i)) return double(single_.sums.sum[i]);
      to_double();
    }
    return double_.sums.sum[i];
  }

 private:
  // True if single precision is exact enough. An edge e seen from v has rounding errors of a few u
  // |v| |e| angle / |v × e|, with u = 2^-24, and never less than u times its angle. Moving a
  // receiver at height h over the plane by u |v| changes the result by u |v| / h, which these sums
  // exceed too. If Lambert's sum is less than 1e-3 of them, the error may reach 1e-4 of it.
  bool is_exact(size_t i) const {
    const BlockReceivers<float>& r = single_.receivers;
    const float distance = std::sqrt(sqr(r.x[i]) + sqr(r.y[i]) + sqr(r.z[i])) + float(diameter_);
    return std::abs(single_.sums.sum[i]) > 1e-3f * distance * single_.sums.angles[i];
  }

  void to_double() {
    is_double_ = true;
    double_.set_receivers(to_doubles, *receivers_, first_, outline_[0]);
    lambert_double(double_.corners, double_.sizes, int(outline_.size()), double_.receivers,
                   double_.sums);
  }

  std::span<const Vec3d> outline_;
  double diameter_ = 0;
  const ReceiverArrays* receivers_ = nullptr;
  size_t first_ = 0;
  bool is_double_ = false;
  Lambert<float> single_;
  Lambert<double> double_;
};

}  // namespace

void unoccluded_irradiance(std::span<const Vec3d> outline, const Vec3d& plane_normal,
                           const ReceiverArrays& receivers, float* out) {
  outline = outline.first(std::min(outline.size(), most_source_corners));
  PolygonSums sums(outline);
  const double level = dot(plane_normal, outline[0]);
  for (size_t first = 0; first < receivers.size; first += vector_lanes) {
    sums.begin_block(receivers, first);
    const size_t count = std::min(vector_lanes, receivers.size - first);
    for (size_t i = 0; i < count; ++i) {
      const Vec3d x = receivers.position_at(first + i);
      double value = 0;
      if (dot(plane_normal, x) > level + plane_rounding(x, outline[0])) {
        if (!receivers.horizons.empty() &&
            lowest_corner(outline, x, Vec3d(receivers.horizons[first + i])) < 0)
          value = clipped_irradiance(outline, x, receivers.normal_at(first + i),
                                     Vec3d(receivers.horizons[first + i]));
        else if (sums.is_cut(i))
          value = polygon_irradiance(outline, x, receivers.normal_at(first + i), Sides::both);
        else
          value = std::min(0.5 * std::abs(sums.sum(i)), pi);
      }
      out[first + i] = float(value);
    }
  }
}

}  // namespace troffer
