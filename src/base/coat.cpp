#include "base/coat.h"

#include <cmath>

namespace troffer {

float mean_reflectance_inside(double index) {
  constexpr int steps = 2000;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double cos2 = (i + 0.5) / steps;  // uniform in cos²: cosine-weighted directions
    const double sin2_out = (1 - cos2) * index * index;
    if (sin2_out >= 1) {
      sum += 1;
      continue;
    }
    const double in = std::sqrt(cos2), out = std::sqrt(1 - sin2_out);
    const double s = (index * in - out) / (index * in + out);
    const double p = (in - index * out) / (in + index * out);
    sum += (s * s + p * p) / 2;
  }
  return float(sum / steps);
}

}  // namespace troffer
