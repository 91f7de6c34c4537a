// Vectors of two and three floats (Vec2, Vec3) or doubles (Vec2d, Vec3d). Used everywhere;
// positions in metres, directions without unit.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace troffer {

template <class T>
struct Vec2T {
  T x{}, y{};
  constexpr Vec2T() = default;
  constexpr Vec2T(T x_, T y_) : x(x_), y(y_) {}
  template <class S>
  explicit constexpr Vec2T(const Vec2T<S>& v) : x(T(v.x)), y(T(v.y)) {}
  constexpr T operator[](size_t i) const { return i == 0 ? x : y; }
  constexpr T& operator[](size_t i) { return i == 0 ? x : y; }
  constexpr Vec2T operator+(Vec2T b) const { return {x + b.x, y + b.y}; }
  constexpr Vec2T operator-(Vec2T b) const { return {x - b.x, y - b.y}; }
  constexpr Vec2T operator*(T s) const { return {x * s, y * s}; }
  constexpr bool operator==(const Vec2T&) const = default;
};

template <class T>
struct Vec3T {
  T x{}, y{}, z{};
  constexpr Vec3T() = default;
  constexpr Vec3T(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
  explicit constexpr Vec3T(T s) : x(s), y(s), z(s) {}
  template <class S>
  explicit constexpr Vec3T(const Vec3T<S>& v) : x(T(v.x)), y(T(v.y)), z(T(v.z)) {}
  constexpr T operator[](size_t i) const { return i == 0 ? x : i == 1 ? y : z; }
  constexpr T& operator[](size_t i) { return i == 0 ? x : i == 1 ? y : z; }
  constexpr Vec3T operator-() const { return {-x, -y, -z}; }
  constexpr Vec3T operator+(const Vec3T& b) const { return {x + b.x, y + b.y, z + b.z}; }
  constexpr Vec3T operator-(const Vec3T& b) const { return {x - b.x, y - b.y, z - b.z}; }
  constexpr Vec3T operator*(const Vec3T& b) const { return {x * b.x, y * b.y, z * b.z}; }
  constexpr Vec3T operator*(T s) const { return {x * s, y * s, z * s}; }
  constexpr Vec3T operator/(T s) const { return {x / s, y / s, z / s}; }
  constexpr Vec3T& operator+=(const Vec3T& b) { return *this = *this + b; }
  constexpr Vec3T& operator-=(const Vec3T& b) { return *this = *this - b; }
  constexpr Vec3T& operator*=(T s) { return *this = *this * s; }
  constexpr bool operator==(const Vec3T&) const = default;
};

template <class T>
constexpr Vec3T<T> operator*(T s, const Vec3T<T>& v) {
  return v * s;
}

using Vec2 = Vec2T<float>;
using Vec3 = Vec3T<float>;
using Vec2d = Vec2T<double>;
using Vec3d = Vec3T<double>;

template <class T>
constexpr T dot(const Vec3T<T>& a, const Vec3T<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
constexpr T dot(const Vec2T<T>& a, const Vec2T<T>& b) {
  return a.x * b.x + a.y * b.y;
}
template <class T>
constexpr Vec3T<T> cross(const Vec3T<T>& a, const Vec3T<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
constexpr T length_squared(const Vec3T<T>& v) {
  return dot(v, v);
}
template <class T>
inline T length(const Vec3T<T>& v) {
  return std::sqrt(dot(v, v));
}
// Unit vector along v, which must not be zero.
template <class T>
inline Vec3T<T> normalize(const Vec3T<T>& v) {
  return v * (T(1) / length(v));
}
template <class T>
constexpr Vec3T<T> min(const Vec3T<T>& a, const Vec3T<T>& b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
template <class T>
constexpr Vec3T<T> max(const Vec3T<T>& a, const Vec3T<T>& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
template <class T>
inline bool is_finite(const Vec3T<T>& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
template <class T>
inline Vec3T<T> abs(const Vec3T<T>& v) {
  return {std::abs(v.x), std::abs(v.y), std::abs(v.z)};
}
template <class T>
constexpr T lerp(T a, T b, T t) {
  return a + (b - a) * t;
}

}  // namespace troffer
