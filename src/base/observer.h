// The eye as numbers: the CIE 1931 2-degree observer, and linear sRGB of XYZ.
// References: [1] Wyman, Sloan & Shirley, "Simple Analytic Approximations to the CIE XYZ Color
//   Matching Functions", JCGT 2(2), 2013.
#pragma once

#include <cmath>

#include "base/rgb.h"
#include "base/vec.h"

namespace troffer {

constexpr int least_visible_nm = 360, most_visible_nm = 830;

// One lobe of [1], Eq. 4: a Gaussian with different widths left and right of its mean; the factors
// are inverse widths.
inline double observer_lobe(double x, double mean, double left, double right) {
  const double t = (x - mean) * (x < mean ? left : right);
  return std::exp(-0.5 * t * t);
}

// The multi-lobe fit to the matching functions [1, Table 1].
inline Vec3d color_matching(double nm) {
  return {0.362 * observer_lobe(nm, 442.0, 0.0624, 0.0374) +
              1.056 * observer_lobe(nm, 599.8, 0.0264, 0.0323) -
              0.065 * observer_lobe(nm, 501.1, 0.0490, 0.0382),
          0.821 * observer_lobe(nm, 568.8, 0.0213, 0.0247) +
              0.286 * observer_lobe(nm, 530.9, 0.0613, 0.0322),
          1.217 * observer_lobe(nm, 437.0, 0.0845, 0.0278) +
              0.681 * observer_lobe(nm, 459.0, 0.0385, 0.0725)};
}

// XYZ -> linear sRGB (IEC 61966-2-1).
inline Rgb rgb_from_xyz(const Vec3d& c) {
  return {float(3.2404542 * c.x - 1.5371385 * c.y - 0.4985314 * c.z),
          float(-0.9692660 * c.x + 1.8760108 * c.y + 0.0415560 * c.z),
          float(0.0556434 * c.x - 0.2040259 * c.y + 1.0572252 * c.z)};
}

}  // namespace troffer
