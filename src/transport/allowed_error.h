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

// Luminance, in typical ones, from which on a display or a tone map shows white.
constexpr double white_luminance = 4;

// Returns the error allowed to a pixel of this luminance. `error` is the relative error asked for,
// `typical` the typical luminance of the picture. Pixels darker than `typical` may have the error
// of a typical one. Brighter pixels are judged relative to their own luminance, as a display or a
// tone map shows them, but at most to white: the pixels at the outline of what is brighter are not
// white.
inline double allowed_error(double error, double luminance, double typical) {
  return error *
         (typical > 0 ? std::clamp(luminance, typical, white_luminance * typical) : luminance);
}

// Above the square of this, the number of a pixel's further samples is in proportion to the
// standard deviation instead of the variance, where every pixel has its own limit of error: a few
// very noisy pixels do not repay the samples that they would need.
constexpr double most_even_samples = 6;

// Allocation of samples. A pixel alone takes `wanted` samples to reach its allowed error; the
// variance of n samples falls as n^-b with b = 1 + evenness. A picture reaches the allowed error in
// the mean square with the fewest samples if each pixel gets p wanted^(b / (1 + b)) of them, by the
// method of Lagrange: in proportion to the standard deviation for b = 1.
inline double share_of_samples(double wanted, double evenness) {
  return std::pow(wanted, (1 + evenness) / (2 + evenness));
}
// Returns the p of a picture with these numbers: p^b is the mean of wanted^(b / (1 + b)).
inline double proportion_of_samples(const std::vector<double>& wanted, double evenness) {
  double sum = 0;
  for (const double w : wanted) sum += share_of_samples(w, evenness);
  return wanted.empty() ? 0 : std::pow(sum / double(wanted.size()), 1 / (1 + evenness));
}

}  // namespace troffer
