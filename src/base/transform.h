// Affine transforms in double precision. Used by importers, instances and exporters. Names read
// target_from_source: world_from_light. Lengths are in metres unless the name says otherwise.
#pragma once

#include <array>

#include "base/vec.h"

namespace troffer {

// x -> linear * x + translation; `columns` are the images of the axes.
struct Affine {
  std::array<Vec3d, 3> columns{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
  Vec3d translation{};

  Vec3d point(const Vec3d& p) const { return vector(p) + translation; }
  Vec3d vector(const Vec3d& v) const {
    return columns[0] * v.x + columns[1] * v.y + columns[2] * v.z;
  }
  double determinant() const { return dot(columns[0], cross(columns[1], columns[2])); }
  bool swaps_handedness() const { return determinant() < 0; }
  // Transforms a normal (covector), without normalising: determinant times the inverse transpose,
  // which exists for singular transforms too. The sign is that of the transformed tangents' cross
  // product.
  Vec3d normal(const Vec3d& n) const {
    return cross(columns[1], columns[2]) * n.x + cross(columns[2], columns[0]) * n.y +
           cross(columns[0], columns[1]) * n.z;
  }
  // (a * b)(x) = a(b(x))
  Affine operator*(const Affine& b) const {
    return {{vector(b.columns[0]), vector(b.columns[1]), vector(b.columns[2])},
            point(b.translation)};
  }

  static Affine translate(const Vec3d& t) {
    Affine a;
    a.translation = t;
    return a;
  }
  static Affine scale(const Vec3d& s) {
    Affine a;
    a.columns = {Vec3d{s.x, 0, 0}, Vec3d{0, s.y, 0}, Vec3d{0, 0, s.z}};
    return a;
  }
  // Right-handed rotation about `axis` (any length but zero).
  static Affine rotate(double angle_rad, const Vec3d& axis);
};

// Inverse transform; the caller checks determinant() != 0.
Affine inverse(const Affine& a);

}  // namespace troffer
