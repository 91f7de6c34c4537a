#include "base/transform.h"

namespace troffer {

Affine Affine::rotate(double angle_rad, const Vec3d& axis) {
  const Vec3d n = normalize(axis);
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  const auto image = [&](const Vec3d& v) {  // Rodrigues' rotation formula
    return v * c + cross(n, v) * s + n * (dot(n, v) * (1 - c));
  };
  Affine a;
  a.columns = {image({1, 0, 0}), image({0, 1, 0}), image({0, 0, 1})};
  return a;
}

Affine inverse(const Affine& a) {
  const double inv_det = 1 / a.determinant();
  const Vec3d r0 = cross(a.columns[1], a.columns[2]) * inv_det;  // rows of the inverse
  const Vec3d r1 = cross(a.columns[2], a.columns[0]) * inv_det;
  const Vec3d r2 = cross(a.columns[0], a.columns[1]) * inv_det;
  Affine b;
  b.columns = {Vec3d{r0.x, r1.x, r2.x}, Vec3d{r0.y, r1.y, r2.y}, Vec3d{r0.z, r1.z, r2.z}};
  b.translation = -b.vector(a.translation);
  return b;
}

}  // namespace troffer
