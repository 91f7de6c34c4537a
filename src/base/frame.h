// Orthonormal frames around a normal. Used to change between local and world directions in shading
// and sampling, in float (Frame) and double (Framed).
//
// References: [1] Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
#pragma once

#include "base/vec.h"

namespace troffer {

// Right-handed orthonormal frame (tangent, bitangent, normal); local z is the normal.
template <class T>
struct FrameT {
  Vec3T<T> tangent{1, 0, 0}, bitangent{0, 1, 0}, normal{0, 0, 1};

  FrameT() = default;
  FrameT(const Vec3T<T>& t, const Vec3T<T>& b, const Vec3T<T>& n)
      : tangent(t), bitangent(b), normal(n) {}
  // Frame around the unit vector n, with arbitrary tangents [1].
  explicit FrameT(const Vec3T<T>& n) : normal(n) {
    const T sign = std::copysign(T(1), n.z);
    const T a = T(-1) / (sign + n.z);
    const T b = n.x * n.y * a;
    tangent = {T(1) + sign * n.x * n.x * a, sign * b, -sign * n.x};
    bitangent = {b, sign + n.y * n.y * a, -n.y};
  }
  Vec3T<T> to_local(const Vec3T<T>& v) const {
    return {dot(v, tangent), dot(v, bitangent), dot(v, normal)};
  }
  Vec3T<T> to_world(const Vec3T<T>& v) const {
    return tangent * v.x + bitangent * v.y + normal * v.z;
  }
};

using Frame = FrameT<float>;
using Framed = FrameT<double>;

}  // namespace troffer
