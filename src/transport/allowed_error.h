// Error that one pixel may have when a picture as a whole must meet an asked error. Used by
// refinement, path tracing's sample counts and the forecast of path tracing. Luminances are in the
// picture's unit. Errors are standard errors of a pixel's luminance in that unit.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace troffer {

// Returns the mean luminance of a picture without its brightest twentieth, which mostly holds
// visible lamps. `values` holds at least one luminance.
inline double usual_luminance(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.resize(values.size() - values.size() / 20);
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

// Trade-off between the error of bright pixels and that of typical ones.
struct BrightPixelError {
  // Largest factor by which the allowed error lies below the one in proportion to the pixel's own
  // luminance.
  double largest_reduction = 4;
  // Exponent p of the allowed error b^(1 - p) t^p, with b the pixel's luminance and t the typical
  // one. The spread of a pixel's samples is proportional to b, and n samples err by b n^(-q / 2).
  // By Lagrange multipliers, a fixed number of samples leaves the least error if pixel errors are
  // proportional to b^(1 / (1 + q)). This gives p = 1/2 for independent samples (q = 1) and p = .6
  // at edges (q = 3/2).
  double of_usual = 0.5;
};

// Returns the error allowed to a pixel of this luminance. `error` is the relative error asked for,
// `typical` the typical luminance of the picture. Pixels darker than `typical` may have the error
// of a typical one. Brighter pixels get an error between that and the one in proportion to their
// own luminance.
inline double allowed_error(double error, double luminance, double typical,
                            const BrightPixelError& of_bright = {}) {
  const double b = std::max(luminance, typical);
  const double t =
      std::max(typical, b * std::pow(of_bright.largest_reduction, -1 / of_bright.of_usual));
  return error * std::pow(b, 1 - of_bright.of_usual) * std::pow(t, of_bright.of_usual);
}

}  // namespace troffer
