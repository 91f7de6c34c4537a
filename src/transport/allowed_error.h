// The error that a pixel may have, where all of a picture is made for one.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace troffer {

// What is usual in a picture of such luminances, at least one: their mean but for the brightest
// twentieth, what shines.
inline double usual_luminance(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.resize(values.size() - values.size() / 20);
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

// How what is bright is allowed to err.
struct AllowedOfBright {
  // By so many times less than its own error, at most.
  double most_times_less = 4;
  // By b^(1 - p) t^p, b the pixel's luminance and t the usual one. What its samples differ by goes
  // with b; where n of them err by b n^(-q / 2), so many in all leave the picture the least error
  // if each pixel errs in proportion to b^(1 / (1 + q)) (by Lagrange's multiplier). So p is 1/2
  // where samples differ by chance (q = 1), and .6 at edges (q = 3/2).
  double of_usual = 0.5;
};

// Of luminance, for `error` of a pixel of this luminance in a picture in which `typical` is usual.
// What is dark may err by as much as what is usual; what is bright by an error between that of its
// own luminance and that of the picture's.
inline double allowed_error(double error, double luminance, double typical,
                            const AllowedOfBright& of_bright = {}) {
  const double b = std::max(luminance, typical);
  const double t =
      std::max(typical, b * std::pow(of_bright.most_times_less, -1 / of_bright.of_usual));
  return error * std::pow(b, 1 - of_bright.of_usual) * std::pow(t, of_bright.of_usual);
}

}  // namespace troffer
