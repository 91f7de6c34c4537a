// Maps from the unit square to disks, hemispheres, spheres and triangles, with densities and
// inverses. Used by all sampling.
//
// References: [1] Shirley & Chiu, "A Low Distortion Map Between Disk and Square", JGT 2(3), 1997.
#pragma once

#include <cmath>

#include "base/units.h"
#include "base/vec.h"

namespace troffer {

// sin x / x and cos x for |x| <= pi/4 by series: relative error below 1e-7 in float. The double
// versions call the library.
inline float sine_over_small(float x) {
  const float z = x * x;
  return 1 + z * (-1.6666667e-1f + z * (8.3333310e-3f + z * (-1.9841e-4f + z * 2.7e-6f)));
}
inline float cosine_small(float x) {
  const float z = x * x;
  return 1 + z * (-0.5f + z * (4.1666667e-2f + z * (-1.3888888e-3f + z * 2.4796e-5f)));
}
inline double sine_over_small(double x) {
  return x == 0 ? 1 : std::sin(x) / x;
}
inline double cosine_small(double x) {
  return std::cos(x);
}

// Concentric area-preserving map [0,1]^2 -> unit disk [1]. Density 1/pi per unit area.
template <class T>
inline Vec2T<T> disk_from_square(const Vec2T<T>& u) {
  const T a = 2 * u.x - 1, b = 2 * u.y - 1;
  if (a == 0 && b == 0) return {0, 0};
  const bool is_across = std::abs(a) > std::abs(b);
  const T r = is_across ? a : b;
  const T angle = T(pi / 4) * (is_across ? b / a : a / b);  // in [-pi/4, pi/4]
  const T along = r * cosine_small(angle), across = r * angle * sine_over_small(angle);
  return is_across ? Vec2T<T>{along, across} : Vec2T<T>{across, along};
}

template <class T>
inline Vec2T<T> square_from_disk(const Vec2T<T>& p) {
  const T r = std::sqrt(p.x * p.x + p.y * p.y);
  if (r == 0) return {T(0.5), T(0.5)};
  T phi = std::atan2(p.y, p.x);
  if (phi < T(-pi / 4)) phi += T(2 * pi);
  T a, b;
  if (phi < T(pi / 4)) {
    a = r;
    b = phi * a / T(pi / 4);
  } else if (phi < T(3 * pi / 4)) {
    b = r;
    a = -(phi - T(pi / 2)) * b / T(pi / 4);
  } else if (phi < T(5 * pi / 4)) {
    a = -r;
    b = (phi - T(pi)) * a / T(pi / 4);
  } else {
    b = -r;
    a = -(phi - T(3 * pi / 2)) * b / T(pi / 4);
  }
  return {(a + 1) / 2, (b + 1) / 2};
}

// Cosine-weighted direction about +z. Density pdf_cosine_hemisphere per unit solid angle.
inline Vec3 cosine_hemisphere_from_square(const Vec2& u) {
  const Vec2 d = disk_from_square(u);
  return {d.x, d.y, std::sqrt(std::max(0.0f, 1 - d.x * d.x - d.y * d.y))};
}
inline float pdf_cosine_hemisphere(float cos_theta) {
  return cos_theta > 0 ? cos_theta * inv_pi_f : 0;
}
inline Vec2 square_from_cosine_hemisphere(const Vec3& w) {
  return square_from_disk(Vec2{w.x, w.y});
}

// Uniform direction on the sphere. Density 1/(4 pi) per unit solid angle.
inline Vec3 sphere_from_square(const Vec2& u) {
  const float z = 1 - 2 * u.x;
  const float r = std::sqrt(std::max(0.0f, 1 - z * z));
  const float phi = 2 * pi_f * u.y;
  return {r * std::cos(phi), r * std::sin(phi), z};
}
inline Vec2 square_from_sphere(const Vec3& w) {
  float v = std::atan2(w.y, w.x) / (2 * pi_f);
  if (v < 0) v += 1;
  return {(1 - w.z) / 2, v};
}

// Uniform barycentrics (b1, b2) of a triangle by the square-root map, without folding. Density 2 in
// the barycentric triangle.
template <class T>
inline Vec2T<T> triangle_from_square(const Vec2T<T>& u) {
  const T s = std::sqrt(u.x);
  return {s * (1 - u.y), s * u.y};  // weights of vertices 1 and 2; vertex 0 has 1 - s
}
template <class T>
inline Vec2T<T> square_from_triangle(const Vec2T<T>& b) {
  const T s = b.x + b.y;
  return {s * s, s > 0 ? b.y / s : T(0)};
}

}  // namespace troffer
