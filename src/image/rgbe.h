// Ward's shared-exponent pixels (RGBE) of Radiance HDR files: three 8-bit mantissas and a common
// exponent. The HDR reader and writer use it.
// References: [1] Ward, "Real Pixels", Graphics Gems II, 1991.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "base/rgb.h"

namespace troffer {

// Mantissas are truncated when packed and read at the centre of their step [1], so that repacking
// changes nothing. Negative values and NaN become 0; values beyond the largest exponent become the
// largest value.
inline std::array<uint8_t, 4> rgbe_from_rgb(Rgb c) {
  constexpr float largest = 0x1.fep126f;  // mantissa 255, exponent byte 255
  for (size_t i = 0; i < 3; ++i) c[i] = c[i] > 0 ? std::fmin(c[i], largest) : 0.0f;
  const float peak = max_component(c);
  if (peak < 1e-32f) return {0, 0, 0, 0};
  int exponent = 0;
  std::frexp(peak, &exponent);
  const auto mantissa = [&](float v) { return uint8_t(std::ldexp(v, 8 - exponent)); };
  return {mantissa(c.r), mantissa(c.g), mantissa(c.b), uint8_t(exponent + 128)};
}

inline Rgb rgb_from_rgbe(const std::array<uint8_t, 4>& p) {
  if (p[3] == 0) return Rgb{0};
  const float step = std::ldexp(1.0f, int(p[3]) - (128 + 8));
  return {(float(p[0]) + 0.5f) * step, (float(p[1]) + 0.5f) * step, (float(p[2]) + 0.5f) * step};
}

}  // namespace troffer
