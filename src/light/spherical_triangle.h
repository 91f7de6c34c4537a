// Uniform sampling of the solid angle of a triangle, with its inverse. The map is Arvo's [1]: first
// the area swept from edge AB, then the arc from B. It is solved through tan(solid angle / 2) [2]
// instead of vertex angles, and gives barycentric coordinates without a ray-plane intersection. No
// nearly equal angles are subtracted, so single precision suffices for tiny and edge-on triangles
// too.
// References: [1] Arvo, "Stratified Sampling of Spherical Triangles", SIGGRAPH 1995.
//   [2] Van Oosterom & Strackee, "The Solid Angle of a Plane Triangle", IEEE TBME 30(2), 1983.
#pragma once

#include <cmath>

#include "base/vec.h"
#include "light/arctangent.h"

namespace troffer {

// Weights of vertices A, B and C, which are >= 0 and sum to one.
template <class T>
struct Barycentric {
  T a = 0, b = 0, c = 0;
};

template <class T>
struct SphericalTriangle {
  Vec3T<T> a, b, c;                            // unit directions to the vertices
  Vec3T<T> edge;                               // from A to C, metres
  T length_a = 0, length_b = 0, length_c = 0;  // distances of the vertices, metres
  T det = 0;                                   // |a · (b × c)|
  T solid_angle = 0;                           // sr; 0 if degenerate

  SphericalTriangle() = default;

  // va, vb, vc: vertices relative to the receiver. six_volumes: |A · (B × C)|, twice the triangle's
  // area times the receiver's height. The caller knows it more precisely than the vertices give it.
  SphericalTriangle(const Vec3T<T>& va, const Vec3T<T>& vb, const Vec3T<T>& vc, T six_volumes)
      : edge(vc - va), length_a(length(va)), length_b(length(vb)), length_c(length(vc)) {
    if (!(six_volumes > 0 && length_a > 0 && length_b > 0 && length_c > 0)) return;
    const T scale_a = 1 / length_a, scale_b = 1 / length_b, scale_c = 1 / length_c;
    a = va * scale_a;
    b = vb * scale_b;
    c = vc * scale_c;
    det = six_volumes * scale_a * scale_b * scale_c;
    solid_angle = 2 * upper_angle(det, 1 + dot(a, b) + dot(b, c) + dot(c, a));  // [2] Eq. 8
  }

  // Returns a point of the triangle for u in [0,1)², with density 1 / solid_angle per steradian.
  Barycentric<T> sample(const Vec2T<T>& u) const {
    // C' lies on the arc AC at angle theta from A, such that ABC' has the share u.x of the area.
    // With C' = cos(theta) a + sin(theta) p, [2] reads
    //   tan(part / 2) = sin(theta) d / ((1 + a·b)(1 + cos(theta)) + sin(theta) b·p),
    // which is linear in tan(theta / 2).
    const T half = u.x * solid_angle / 2;
    const T sin_half = std::sin(half), cos_half = std::cos(half);
    const Vec3T<T> across = edge - a * dot(a, edge);
    const T across_length = length(across);
    // Both are multiplied by the length of `across`; 1 + a·b = |a + b|² / 2.
    const T numerator = sin_half * across_length * length_squared(a + b) / 2;
    const T denominator = cos_half * det * length_c - sin_half * dot(b, across);
    const T norm = numerator * numerator + denominator * denominator;
    T sin_theta = 0, cos_theta = 1;
    if (norm > 0) {
      const T scale = 1 / norm;
      sin_theta = 2 * numerator * denominator * scale;
      cos_theta = (denominator - numerator) * (denominator + numerator) * scale;
    }
    const T weight_c = std::max(sin_theta * length_c / across_length, T(0));
    const T weight_a = std::max(cos_theta - dot(a, c) * weight_c, T(0));
    // On the arc from B to C', 1 - cos of the angle from B is uniform.
    const T gap = length_squared(b - (a * weight_a + c * weight_c)) / 2;  // 1 - b·C'
    const T along = std::sqrt(u.y * (2 - u.y * gap) / (2 - gap));
    const T weight_b = std::max(1 - u.y * gap - along * (1 - gap), T(0));
    // Multiplied by all three lengths, to avoid divisions.
    const Barycentric<T> w{along * weight_a * length_b * length_c, weight_b * length_a * length_c,
                           along * weight_c * length_a * length_b};
    const T scale = 1 / (w.a + w.b + w.c);
    return {w.a * scale, w.b * scale, w.c * scale};
  }

  // Inverse of sample(). Use it in double precision.
  Vec2T<T> square_from_point(const Barycentric<T>& point) const {
    const T wa = point.a * length_a, wb = point.b * length_b, wc = point.c * length_c;
    const Vec3T<T> foot = a * wa + c * wc;
    const T foot_length = length(foot);
    if (!(foot_length > 0)) return {0, 0};  // the point is B
    const Vec3T<T> foot_unit = foot / foot_length;
    const T part = 2 * std::atan2(det * wc / foot_length,
                                  1 + dot(a, b) + dot(b, foot_unit) + dot(a, foot_unit));
    const T gap = length_squared(b - foot_unit);
    const T gap_point = length_squared(b - normalize(foot + b * wb));
    return {part / solid_angle, gap > 0 ? gap_point / gap : T(0)};
  }
};

}  // namespace troffer
