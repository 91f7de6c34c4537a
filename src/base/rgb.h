// Linear colour with Rec. 709 (sRGB) primaries: radiance, irradiance or reflectance per channel.
// Used for all light and material values.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace troffer {

struct Rgb {
  float r = 0, g = 0, b = 0;
  constexpr Rgb() = default;
  explicit constexpr Rgb(float s) : r(s), g(s), b(s) {}
  constexpr Rgb(float r_, float g_, float b_) : r(r_), g(g_), b(b_) {}
  constexpr float operator[](size_t i) const { return i == 0 ? r : i == 1 ? g : b; }
  constexpr float& operator[](size_t i) { return i == 0 ? r : i == 1 ? g : b; }
  constexpr Rgb operator+(Rgb o) const { return {r + o.r, g + o.g, b + o.b}; }
  constexpr Rgb operator-(Rgb o) const { return {r - o.r, g - o.g, b - o.b}; }
  constexpr Rgb operator*(Rgb o) const { return {r * o.r, g * o.g, b * o.b}; }
  constexpr Rgb operator/(Rgb o) const { return {r / o.r, g / o.g, b / o.b}; }
  constexpr Rgb operator*(float s) const { return {r * s, g * s, b * s}; }
  constexpr Rgb operator/(float s) const { return {r / s, g / s, b / s}; }
  constexpr Rgb& operator+=(Rgb o) { return *this = *this + o; }
  constexpr Rgb& operator*=(Rgb o) { return *this = *this * o; }
  constexpr Rgb& operator*=(float s) { return *this = *this * s; }
  constexpr bool operator==(const Rgb&) const = default;
  constexpr bool is_black() const { return r == 0 && g == 0 && b == 0; }
};
constexpr Rgb operator*(float s, Rgb c) {
  return c * s;
}

// Relative luminance Y of linear Rec. 709 colour.
constexpr float luminance(Rgb c) {
  return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b;
}
constexpr float max_component(Rgb c) {
  return std::max(c.r, std::max(c.g, c.b));
}
constexpr float average(Rgb c) {
  return (c.r + c.g + c.b) * (1.0f / 3.0f);
}
inline bool is_finite(Rgb c) {
  return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b);
}
constexpr Rgb clamp01(Rgb c) {
  return {std::clamp(c.r, 0.0f, 1.0f), std::clamp(c.g, 0.0f, 1.0f), std::clamp(c.b, 0.0f, 1.0f)};
}

// The sRGB transfer function (IEC 61966-2-1), encoded value in [0,1] <-> linear value.
inline float linear_from_srgb(float v) {
  return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}
inline float srgb_from_linear(float v) {
  return v <= 0.0031308f ? v * 12.92f : 1.055f * std::pow(v, 1.0f / 2.4f) - 0.055f;
}

}  // namespace troffer
