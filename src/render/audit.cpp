#include "render/audit.h"

#include <cmath>

#include "base/units.h"

namespace troffer {

double relative_bias(const std::vector<Measurement>& points,
                     const std::vector<Measurement>& others) {
  double squares = 0, weights = 0, count = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const double e = points[i].illuminance_lx;
    const double variance = sqr(points[i].standard_error) + sqr(others[i].standard_error);
    if (!(e > 0) || !(others[i].standard_error > 0)) continue;
    squares += sqr(others[i].illuminance_lx - e) / variance;
    weights += sqr(e) / variance;
    count += 1;
  }
  if (count == 0) return 0;
  // The 99 % quantile of chi-squared, by Wilson and Hilferty.
  const double part = 2 / (9 * count), root = 1 - part + 2.326 * std::sqrt(part);
  if (squares <= count * root * root * root) return 0;
  return std::sqrt((squares - count) / weights);
}

}  // namespace troffer
