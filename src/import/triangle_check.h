// Test for triangles that can be rendered. Importers apply it through clean_mesh or while reading.
// Each thread may count with an object of its own; add() combines them.
#pragma once

#include <cstddef>

#include "base/log.h"
#include "base/vec.h"

namespace troffer {

// Rejects triangles without area or with unusable corners, and counts them.
class TriangleCheck {
 public:
  // True if the triangle can be rendered. Its corners must lie within 1e9 m of the origin, so that
  // the square of an area fits a float. Its area must exceed the rounding of floats.
  bool is_good(const Vec3& a, const Vec3& b, const Vec3& c);
  void add(const TriangleCheck& other);  // adds its counts
  size_t bad() const { return not_finite_ + without_area_; }
  // Adds one warning for each kind of rejected triangles.
  void report(WarningLog& warnings) const;

 private:
  size_t not_finite_ = 0, without_area_ = 0;
};

}  // namespace troffer
