// Uniform sampling of the solid angle of a rectangle, with its inverse. The map is that of [1],
// computed with sines and cosines: one atan2 and one sine and cosine per sample. The solid angle is
// computed as in [2], which stays accurate where the sum of the corner angles cancels.
// References: [1] Ureña, Fajardo & King, "An Area-Preserving Parametrization for Spherical
//   Rectangles", EGSR 2013.
//   [2] Van Oosterom & Strackee, "The Solid Angle of a Plane Triangle", IEEE TBME 30(2), 1983.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/simd.h"
#include "base/vec.h"
#include "light/arctangent.h"

namespace troffer {

// The rectangle [x0,x1] × [y0,y1] in the plane at height z > 0 over the receiver, which is the
// origin. Any unit of length; sizes near 1 keep single precision from overflow.
template <class T>
struct SphericalRectangle {
  T x0, x1, y0, y1, z;
  T r00, r10, r11, r01;  // distances of the corners
  T solid_angle;         // sr

  TROFFER_ALWAYS_INLINE SphericalRectangle(T x0_, T x1_, T y0_, T y1_, T z_)
      : x0(x0_), x1(x1_), y0(y0_), y1(y1_), z(z_) {
    r00 = std::sqrt(x0 * x0 + y0 * y0 + z * z);
    r10 = std::sqrt(x1 * x1 + y0 * y0 + z * z);
    r11 = std::sqrt(x1 * x1 + y1 * y1 + z * z);
    r01 = std::sqrt(x0 * x0 + y1 * y1 + z * z);
    solid_angle = part(x1, r10, r11);
  }

  // Solid angle of [x0,x] × [y0,y1]. rx0, rx1: distances of (x,y0) and (x,y1). The half solid
  // angles of two triangles are arguments of complex numbers [2], which are multiplied to add them.
  TROFFER_ALWAYS_INLINE T part(T x, T rx0, T rx1) const {
    const T yy0 = y0 * y0 + z * z, yy1 = y1 * y1 + z * z, yy01 = y0 * y1 + z * z;
    const T det = (x - x0) * (y1 - y0) * z;
    const T diagonal = x0 * x + yy01;  // (x0,y0)·(x,y1)
    const T re1 = r00 * rx0 * rx1 + (x0 * x + yy0) * rx1 + (x * x + yy01) * r00 + diagonal * rx0;
    const T re2 = r00 * rx1 * r01 + diagonal * r01 + (x0 * x + yy1) * r00 + (x0 * x0 + yy01) * rx1;
    return 2 * upper_angle(std::max(det * (re1 + re2), T(0)), re1 * re2 - det * det);
  }

  // Returns (x, y) on the rectangle for u in [0,1)², with density 1 / solid_angle per steradian.
  TROFFER_ALWAYS_INLINE Vec2T<T> sample(const Vec2T<T>& u) const {
    // k is 2 pi minus the corner angles at x0 [1, Eq. 3], as (cos k, sin k).
    const T h0 = std::sqrt(y0 * y0 + z * z), h1 = std::sqrt(y1 * y1 + z * z);
    const T k_scale = 1 / ((x0 * x0 + z * z) * h0 * h1);
    const T cos_k = -(x0 * x0 * y0 * y1 + z * z * r00 * r01) * k_scale;
    const T sin_k = -z * x0 * (y1 * r00 - y0 * r01) * k_scale;
    const T part_angle = u.x * solid_angle;
    T s, c;
    sine_cosine(part_angle, s, c);
    const T cos_au = c * cos_k - s * sin_k, sin_au = s * cos_k + c * sin_k;
    // x from f_u = (cos(au) b0 - b1) / sin(au) [1, Eq. 4]: x = z / sqrt(f_u² + b0² - 1), where b0²
    // - 1 = -z² / h0². The roles of the two long edges may be exchanged; the longer of h0, h1 loses
    // fewer digits.
    const T b0 = -y0 / h0, b1 = y1 / h1;
    const T first = T(h0 >= h1);  // 0 or 1
    const T h = std::max(h0, h1);
    const T d = h * (first * (cos_au * b0 - b1) + (1 - first) * (cos_au * b1 - b0));
    const T root =
        std::sqrt(std::max(d * d - z * z * sin_au * sin_au, std::numeric_limits<T>::min()));
    const T x = std::min(std::max(z * sin_au * h * std::copysign(T(1), d) / root, x0), x1);
    // y: the sine of its elevation over the plane (x, z) is uniform [1, Eq. 8].
    const T dd = x * x + z * z;
    const T s0 = y0 / std::sqrt(dd + y0 * y0), s1 = y1 / std::sqrt(dd + y1 * y1);
    const T sv = s0 + u.y * (s1 - s0);
    const T y = sv * std::sqrt(dd / std::max(1 - sv * sv, std::numeric_limits<T>::min()));
    return {x, std::min(std::max(y, y0), y1)};
  }

  // Inverse of sample(). Use it in double precision.
  Vec2T<T> square_from_point(const Vec2T<T>& p) const {
    const T dd = p.x * p.x + z * z;
    const T rx0 = std::sqrt(dd + y0 * y0), rx1 = std::sqrt(dd + y1 * y1);
    const T s0 = y0 / rx0, s1 = y1 / rx1, sv = p.y / std::sqrt(dd + p.y * p.y);
    return {part(p.x, rx0, rx1) / solid_angle, (sv - s0) / (s1 - s0)};
  }
};

}  // namespace troffer
