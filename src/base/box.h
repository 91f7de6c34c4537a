// Axis-aligned boxes of float (Box) and double (Boxd). Used for bounds everywhere. An empty box has
// lower > upper; growing it by a point makes it that point.
#pragma once

#include <limits>

#include "base/vec.h"

namespace troffer {

template <class T>
struct BoxT {
  Vec3T<T> lower{std::numeric_limits<T>::infinity()};
  Vec3T<T> upper{-std::numeric_limits<T>::infinity()};

  void grow(const Vec3T<T>& p) {
    lower = min(lower, p);
    upper = max(upper, p);
  }
  void grow(const BoxT& b) {
    lower = min(lower, b.lower);
    upper = max(upper, b.upper);
  }
  bool is_empty() const {
    return !(lower.x <= upper.x && lower.y <= upper.y && lower.z <= upper.z);
  }
  Vec3T<T> centre() const { return (lower + upper) * T(0.5); }
  Vec3T<T> extent() const { return upper - lower; }
  T diagonal() const { return is_empty() ? T(0) : length(extent()); }
};

using Box = BoxT<float>;
using Boxd = BoxT<double>;

}  // namespace troffer
