#include "cells/linear_fit.h"

#include <algorithm>
#include <cmath>

namespace troffer {

namespace {

// Regularisation: pulls slopes that the neighbours hardly determine towards zero.
constexpr double ridge = 1e-3;

Rgb as_rgb(const Vec3d& v) {
  return {float(v.x), float(v.y), float(v.z)};
}
double luminance_of(const Vec3d& v) {
  return 0.2126 * v.x + 0.7152 * v.y + 0.0722 * v.z;
}

}  // namespace

void LinearFit::add(float u, float v, float kernel, float rays, Rgb value) {
  const double w = double(kernel) * double(rays), x = double(u), y = double(v);
  weights_.add(w, x, y);
  squares_.add(double(kernel) * w, x, y);
  const Vec3d e{double(value.r), double(value.g), double(value.b)};
  sum_ += e * w;
  sum_u_ += e * (w * x);
  sum_v_ += e * (w * y);
  kernels_ += double(kernel);
  luminance_squared_ += w * double(luminance(value)) * double(luminance(value));
  ++count_;
}

bool LinearFit::solve(FittedLight& out) const {
  const Moments& m = weights_;
  if (!(m.one > 0)) return false;
  const bool is_plane = count_ >= least_neighbours;
  const double more = is_plane ? ridge * m.one : 1e12 * m.one;
  const double uu = m.uu + more, vv = m.vv + more;
  // First row of the inverse of the normal equations' matrix: gives the value at the origin.
  const double c0 = uu * vv - m.uv * m.uv, c1 = m.uv * m.v - m.u * vv, c2 = m.u * m.uv - uu * m.v;
  const double determinant = m.one * c0 + m.u * c1 + m.v * c2;
  if (!(determinant > 0)) return false;
  const double a = c0 / determinant, b = c1 / determinant, c = c2 / determinant;
  const Vec3d value = sum_ * a + sum_u_ * b + sum_v_ * c;
  out.value = as_rgb({std::max(value.x, 0.0), std::max(value.y, 0.0), std::max(value.z, 0.0)});
  const Moments& s = squares_;
  const double variance = a * a * s.one + 2 * a * b * s.u + 2 * a * c * s.v + b * b * s.uu +
                          2 * b * c * s.uv + c * c * s.vv;
  out.neighbours = variance > 0 ? 1 / variance : 1;
  // Σ w (E - fit)², with slopes by the other rows.
  const double y0 = luminance_of(sum_), yu = luminance_of(sum_u_), yv = luminance_of(sum_v_);
  const double d = (m.one * vv - m.v * m.v) / determinant,
               e = (m.u * m.v - m.one * m.uv) / determinant,
               f = (m.one * uu - m.u * m.u) / determinant;
  const double slope_u = b * y0 + d * yu + e * yv, slope_v = c * y0 + e * yu + f * yv;
  const double residual = luminance_squared_ - luminance_of(value) * y0 - slope_u * yu -
                          slope_v * yv - more * (slope_u * slope_u + slope_v * slope_v);
  // The residual is the variance times Σ kernel, less what the fit takes of it: the trace of its
  // hat matrix.
  const double taken = a * s.one + 2 * b * s.u + 2 * c * s.v + d * s.uu + 2 * e * s.uv + f * s.vv;
  const double left = kernels_ - taken;
  out.spread = left > 1e-3 * kernels_ ? std::max(residual, 0.0) / left : 0;
  return is_plane;
}

}  // namespace troffer
