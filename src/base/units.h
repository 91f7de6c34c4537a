// Mathematical constants and unit conversions. SI throughout; any other unit is part of the name,
// such as angle_deg or diagonal_mm.
#pragma once

namespace troffer {

constexpr double pi = 3.14159265358979323846;
constexpr float pi_f = 3.14159265358979323846f;
constexpr float inv_pi_f = 0.31830988618379067154f;
constexpr float one_minus_epsilon = 0x1.fffffep-1f;  // largest float below 1

// Luminous efficacy of equal-energy white, lm/W: converts radiometric scenes to photometric ones.
// Conventional: Radiance's value.
constexpr double luminous_efficacy = 179.0;

constexpr double rad_from_deg(double deg) {
  return deg * (pi / 180.0);
}
constexpr double deg_from_rad(double rad) {
  return rad * (180.0 / pi);
}
template <class T>
constexpr T sqr(T x) {
  return x * x;
}

}  // namespace troffer
