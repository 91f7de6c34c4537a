// Mean of samples that are dealt to independently scrambled sets, with its standard error by the
// spread of the sets. Used for measuring points, their audit, and lightmaps (bake/).
#pragma once

#include "base/vec.h"

namespace troffer {

// Number of sets. It is enough for a reliable error; the spread of stratified samples within one
// set does not show it.
constexpr int most_sets = 32;

// Returns the two-sided 95 % quantile of Student's t with n >= 1 degrees of freedom, within 0.3 %.
double t_quantile_95(int n);

// Running moments over sets.
class SampleSets {
 public:
  // Adds a set, given by the mean of its samples: irradiance, and its luminance.
  void add(const Vec3d& irradiance, double luminance);

  const Vec3d& irradiance() const { return irradiance_; }
  double luminance() const { return mean_; }
  // Standard error of luminance(): 95 % of the intervals luminance() ± 1.96 standard errors hold
  // the true value. 0 with fewer than two sets.
  double standard_error() const;
  // Kurtosis of the sets' luminances: fourth central moment / squared variance. 3 for a normal
  // distribution or equal sets; up to the number of sets if one differs from all others.
  double kurtosis() const;

 private:
  Vec3d irradiance_;
  double mean_ = 0;
  double squares_ = 0, cubes_ = 0, fourths_ = 0;  // sums of powers of deviations
  int sets_ = 0;
};

}  // namespace troffer
