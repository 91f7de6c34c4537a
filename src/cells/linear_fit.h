// Linear fit of irradiance over neighbours in a plane by weighted least squares, evaluated at the
// plane's origin. Used by gather/gather_pass.h for records of a picture.
#pragma once

#include "base/rgb.h"
#include "base/vec.h"

namespace troffer {

struct FittedLight {
  Rgb value;
  // Number of neighbours of weight 1 whose mean has the variance of `value`.
  double neighbours = 0;
  double spread = 0;  // variance of luminance of a neighbour of weight 1 about the fit
};

// Sums over neighbours. Add them all, then solve.
class LinearFit {
 public:
  // Adds a neighbour at (u, v), in radii. kernel: weight by nearness. rays: inverse of its
  // variance.
  void add(float u, float v, float kernel, float rays, Rgb value);
  int count() const { return count_; }
  // Sets `out`. False if there are too few neighbours for a plane: `out` is then their mean.
  bool solve(FittedLight& out) const;

 private:
  // Moments by weights w = kernel × rays: of 1, u, v, u², uv, v². Those by w² / rays are alike.
  struct Moments {
    double one = 0, u = 0, v = 0, uu = 0, uv = 0, vv = 0;
    void add(double w, double x, double y) {
      one += w;
      u += w * x;
      v += w * y;
      uu += w * x * x;
      uv += w * x * y;
      vv += w * y * y;
    }
  };
  Moments weights_, squares_;
  Vec3d sum_, sum_u_, sum_v_;
  double luminance_squared_ = 0, kernels_ = 0;
  int count_ = 0;
  static constexpr int least_neighbours = 6;
};

}  // namespace troffer
