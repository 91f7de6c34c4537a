// Error that one pixel may have when a picture as a whole must meet an asked error. Used by
// refinement, path tracing's sample counts and the forecast of path tracing. Luminances are in the
// picture's unit. Errors are standard errors of a pixel's luminance in that unit.
#pragma once

#include <algorithm>
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

// Returns the error allowed to a pixel of this luminance. `error` is the relative error asked for,
// `typical` the typical luminance of the picture. Pixels darker than `typical` may have the error
// of a typical one. Brighter pixels are judged relative to their own luminance, as a display or a
// tone map shows them, but at most to four times the typical one: what is brighter is shown white,
// and the pixels at its outline are not.
inline double allowed_error(double error, double luminance, double typical) {
  constexpr double white = 4;  // times the typical luminance
  return error * (typical > 0 ? std::clamp(luminance, typical, white * typical) : luminance);
}

}  // namespace troffer
