// Samples dealt to independently scrambled sets, whose means tell how far their own mean is off.
#pragma once

#include "base/vec.h"

namespace troffer {

// The spread of so many means tells the error truly, which the spread of stratified samples would
// not.
constexpr int most_sets = 32;

// Two-sided 95 % quantile of Student's t with n >= 1 degrees of freedom, within 0.3 %.
double t_quantile_95(int n);

// What sets have brought, one after the other.
class SampleSets {
 public:
  // The mean of a set's samples: irradiance, and its luminance.
  void add(const Vec3d& irradiance, double luminance);

  const Vec3d& irradiance() const { return irradiance_; }
  double luminance() const { return mean_; }
  // Of luminance(), such that 95 % of the intervals luminance() ± 1.96 standard errors hold the
  // true value; 0 of fewer than two sets.
  double standard_error() const;
  // Fourth central moment of the sets' luminances over the square of the second: 3 of a normal
  // distribution, up to as much as there are sets where one differs from all others. 3 where they
  // do not differ.
  double kurtosis() const;

 private:
  Vec3d irradiance_;
  double mean_ = 0;
  double squares_ = 0, cubes_ = 0, fourths_ = 0;  // sums of powers of what sets differ from it by
  int sets_ = 0;
};

}  // namespace troffer
