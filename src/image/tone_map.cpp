#include "image/tone_map.h"

#include <cmath>

#include "base/parallel.h"

namespace troffer {

namespace {

// Hable's curve with the constants of [1].
constexpr double hable(double x) {
  constexpr double a = 0.15, b = 0.50, c = 0.10, d = 0.20, e = 0.02, f = 0.30;
  return (x * (a * x + c * b) + d * e) / (x * (a * x + b) + d * f) - e / f;
}

constexpr double hable_white = 11.2;
// Solves hable(scale * 0.18) = 0.18 * hable(hable_white).
constexpr double hable_scale = 2.9275228328801886;

uint8_t quantise(float v) {
  return uint8_t(255 * v + 0.5f);
}

}  // namespace

float filmic(float linear) {
  if (!(linear > 0)) return 0;
  const double x = hable_scale * double(linear);
  return x >= hable_white ? 1.0f : float(hable(x) / hable(hable_white));
}

std::vector<uint8_t> srgb8(const Image& image, const Display& display, int threads) {
  std::vector<uint8_t> out(image.pixels.size() * 3);
  const auto gain = float(std::exp2(display.exposure_stops));
  const auto width = size_t(image.width);
  parallel_for(size_t(image.height), threads, [&](size_t y) {
    for (size_t i = y * width; i < (y + 1) * width; ++i)
      for (size_t c = 0; c < 3; ++c) {
        float v = image.pixels[i][c] * gain;
        if (display.tone_map == ToneMap::filmic) v = filmic(v);
        v = v > 0 ? std::fmin(v, 1.0f) : 0.0f;  // NaN fails the comparison
        out[3 * i + c] = quantise(srgb_from_linear(v));
      }
  });
  return out;
}

}  // namespace troffer
