// A linear fit of irradiance over neighbours in a plane, by weighted least squares, taken at the
// plane's origin.
#pragma once

#include "base/rgb.h"
#include "base/vec.h"

namespace troffer {

struct FittedLight {
  Rgb value;
  // The variance of `value` is that of one neighbour (of weight 1) over this.
  double neighbours = 0;
  double spread = 0;  // variance of luminance of a neighbour of weight 1 about the fit
};

// Sums over neighbours.
class LinearFit {
 public:
  // At (u, v), in units of the radius. kernel: how near it is; rays: the inverse of its variance.
  void add(float u, float v, float kernel, float rays, Rgb value);
  int count() const { return count_; }
  // Whether they are enough for a plane; else their mean is all they tell …
  bool is_plane() const { return count_ >= least_neighbours; }
  // … of this far from the origin, in radii.
  double offset() const;
  // False where there are too few neighbours for a plane: then it is their mean.
  bool solve(FittedLight& out) const;

 private:
  // of weights w = kernel × rays: 1, u, v, u², uv, v²; and of w² / rays, likewise
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
