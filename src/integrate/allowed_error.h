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

// Of luminance, for `error` of a pixel of this luminance in a picture in which `typical` is usual.
// What is dark may err by as much as what is usual; what is bright by an error between that of its
// own luminance and that of the picture's, at most so many times less than its own.
constexpr double usual_times_less = 4;
inline double allowed_error(double error, double luminance, double typical,
                            double most_times_less = usual_times_less) {
  const double bright = std::max(luminance, typical);
  return error *
         std::sqrt(bright * std::max(typical, bright / (most_times_less * most_times_less)));
}

}  // namespace troffer
