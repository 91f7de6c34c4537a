#include "render/sample_sets.h"

#include <array>
#include <cmath>
#include <cstddef>

#include "base/units.h"

namespace troffer {

// Cornish-Fisher expansion about the normal quantile; exact values up to n = 5.
double t_quantile_95(int n) {
  constexpr std::array<double, 5> exact{12.7062, 4.3027, 3.1824, 2.7764, 2.5706};
  if (n <= 5) return exact[size_t(n - 1)];
  const double z = 1.959964, z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
  const double v = n;
  return z + (z3 + z) / (4 * v) + (5 * z5 + 16 * z3 + 3 * z) / (96 * v * v) +
         (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * v * v * v);
}

void SampleSets::add(const Vec3d& irradiance, double luminance) {
  ++sets_;
  irradiance_ += (irradiance - irradiance_) * (1.0 / sets_);
  // Pébay, "Formulas for Robust, One-Pass Parallel Computation of Covariances and Arbitrary-Order
  // Statistical Moments", Sandia report 2008-6212, Eq. 2.1.
  const double n = sets_, before = luminance - mean_, step = before / n;
  const double square = before * step * (n - 1);
  mean_ += step;
  fourths_ +=
      square * sqr(step) * (n * n - 3 * n + 3) + 6 * sqr(step) * squares_ - 4 * step * cubes_;
  cubes_ += square * step * (n - 2) - 3 * step * squares_;
  squares_ += square;
}

double SampleSets::kurtosis() const {
  return squares_ > 0 ? sets_ * fourths_ / sqr(squares_) : 3;
}

double SampleSets::standard_error() const {
  if (sets_ < 2) return 0;
  return std::sqrt(squares_ / (sets_ - 1) / sets_) * (t_quantile_95(sets_ - 1) / 1.959964);
}

}  // namespace troffer
