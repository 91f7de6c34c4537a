// Fast arctangent for the upper half plane, and fast sine and cosine. Both are branch-free, so that
// loops over them vectorize; light sampling and closed-form irradiance use them.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "base/simd.h"
#include "base/units.h"

namespace troffer {

// Returns the angle of (x, y), y >= 0, in [0, pi]; 0 for (0,0). Relative error below 2e-7 in float,
// 1e-15 in double. After folding to |t| <= tan(pi/8), atan(t)/t is a polynomial in t². The
// coefficients come from Chebyshev interpolation, of a degree that matches the type's rounding.
template <class T>
TROFFER_ALWAYS_INLINE T upper_angle(T y, T x) {
  const T ax = std::abs(x), high = std::max(ax, y), low = std::min(ax, y);
  // Factors of 0 or 1 replace branches, which would be unpredictable and prevent vectorization.
  const T is_steep = T(low > T(0.41421356237309505) * high);
  const T t =
      (low - is_steep * high) / std::max(high + is_steep * low, std::numeric_limits<T>::min());
  const T z = t * t;
  T p;
  if constexpr (std::is_same_v<T, float>) {
    p = 0.079762918f;
    p = p * z - 0.13848490f;
    p = p * z + 0.19974082f;
    p = p * z - 0.33332786f;
    p = p * z + 0.99999998f;
  } else {
    const double zz = z * z;  // even and odd powers apart, for shorter dependency chains
    const double even =
        ((((0.037965257453865936 * zz + 0.058468782973308725) * zz + 0.076920453309022250) * zz +
          0.11111110744919658) *
             zz +
         0.19999999999940891) *
            zz +
        1;
    const double odd =
        ((((0.017805397205419445 * zz + 0.050351024566015518) * zz + 0.066629518136291901) * zz +
          0.090908968090640270) *
             zz +
         0.14285714279250245) *
            zz +
        0.33333333333333121;
    p = even - z * odd;
  }
  const T swaps = T(y > ax), is_left = T(x < 0);
  const T folded = t * p + is_steep * T(pi / 4);
  const T right = swaps * T(pi / 2) + (1 - 2 * swaps) * folded;
  return is_left * T(pi) + (1 - 2 * is_left) * right;
}

// Sine and cosine of an angle in [0, 2 pi]. In float they are polynomials from Chebyshev
// interpolation, with an absolute error below 2e-7. A NaN, which branch-free loops may pass, gives
// the values at 0.
TROFFER_ALWAYS_INLINE void sine_cosine(float any, float& sine, float& cosine) {
  const float angle = std::min(float(2 * pi), std::max(0.0f, any));
  const float quarter = float(int(angle * float(2 / pi) + 0.5f));
  const float r = (angle - quarter * 1.5703125f) - quarter * 4.83826794897e-4f;  // in ±pi/4
  const float z = r * r;
  const float s = r * (1 + z * (-1.6666654611e-1f + z * (8.3321608736e-3f - z * 1.9515295891e-4f)));
  const float c =
      1 - 0.5f * z +
      z * z * (4.166664568298827e-2f + z * (-1.388731625493765e-3f + z * 2.443315711809948e-5f));
  const int k = int(quarter);
  const bool is_odd = (k & 1) != 0;
  const float a = is_odd ? c : s, b = is_odd ? s : c;
  sine = (k & 2) != 0 ? -a : a;
  cosine = ((k + 1) & 2) != 0 ? -b : b;
}
inline void sine_cosine(double angle, double& sine, double& cosine) {
  sine = std::sin(angle);
  cosine = std::cos(angle);
}

}  // namespace troffer
