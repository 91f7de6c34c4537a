#include "import/triangle_check.h"

#include <algorithm>
#include <cmath>

namespace troffer {

namespace {

constexpr float largest_coordinate = 1e9f;

bool is_usable(const Vec3& p) {
  return std::abs(p.x) <= largest_coordinate && std::abs(p.y) <= largest_coordinate &&
         std::abs(p.z) <= largest_coordinate;  // false for NaN
}

// The first test makes sure that normals computed in floats are not zero.
bool is_degenerate(const Vec3& a, const Vec3& b, const Vec3& c) {
  if (!(length_squared(cross(b - a, c - a)) > 0)) return true;
  const Vec3d ab = Vec3d(b) - Vec3d(a), ac = Vec3d(c) - Vec3d(a);
  const double longest_squared = std::max(length_squared(ab), length_squared(ac));
  return length(cross(ab, ac)) <= 1e-9 * longest_squared;
}

}  // namespace

bool TriangleCheck::is_good(const Vec3& a, const Vec3& b, const Vec3& c) {
  if (!is_usable(a) || !is_usable(b) || !is_usable(c)) {
    ++not_finite_;
    return false;
  }
  if (is_degenerate(a, b, c)) {
    ++without_area_;
    return false;
  }
  return true;
}

void TriangleCheck::add(const TriangleCheck& other) {
  not_finite_ += other.not_finite_;
  without_area_ += other.without_area_;
}

void TriangleCheck::report(WarningLog& warnings) const {
  if (not_finite_ > 0)
    warnings.add("triangles with vertices that are not finite are left out", not_finite_);
  if (without_area_ > 0) warnings.add("triangles without area are left out", without_area_);
}

}  // namespace troffer
