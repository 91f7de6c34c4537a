// Which triangles can be rendered.
#pragma once

#include <cstddef>

#include "base/log.h"
#include "base/vec.h"

namespace troffer {

// Sorts out triangles that have no area or a corner that cannot be used, and counts them.
class TriangleCheck {
 public:
  // Whether the triangle may stay. Its corners must lie within 1e9 m of the origin, where the
  // square of an area is still a float, and its area must not be lost in the rounding of floats.
  bool is_good(const Vec3& a, const Vec3& b, const Vec3& c);
  void add(const TriangleCheck& other);  // its counts
  size_t bad() const { return not_finite_ + without_area_; }
  // One warning per kind that occurred.
  void report(WarningLog& warnings) const;

 private:
  size_t not_finite_ = 0, without_area_ = 0;
};

}  // namespace troffer
