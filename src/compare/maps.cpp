#include "compare/maps.h"

#include <array>
#include <cmath>

#include "base/error.h"
#include "compare/flip.h"

namespace troffer {

namespace {

// Every 32nd entry of magma's table, sRGB bytes [1].
constexpr std::array<std::array<uint8_t, 3>, 9> magma_table{{{0, 0, 4},
                                                             {28, 16, 68},
                                                             {79, 18, 123},
                                                             {129, 37, 129},
                                                             {181, 54, 122},
                                                             {229, 80, 100},
                                                             {251, 135, 97},
                                                             {254, 194, 135},
                                                             {252, 253, 191}}};

template <class F>
Image map_pixels(const Image& image, const Image& reference, const F& f) {
  TROFFER_CHECK(image.width == reference.width && image.height == reference.height);
  Image out(image.width, image.height);
  for (size_t i = 0; i < out.pixels.size(); ++i)
    out.pixels[i] = f(image.pixels[i], reference.pixels[i]);
  return out;
}

}  // namespace

Rgb magma(float value) {
  const float t = value > 0 ? std::fmin(value, 1.0f) * float(magma_table.size() - 1) : 0.0f;
  const size_t i = std::min(size_t(t), magma_table.size() - 2);
  const float fraction = t - float(i);
  Rgb out;
  for (size_t c = 0; c < 3; ++c) {
    const float low = float(magma_table[i][c]), high = float(magma_table[i + 1][c]);
    out[c] = linear_from_srgb((low + (high - low) * fraction) / 255);
  }
  return out;
}

Image magma_map(const std::vector<float>& values, int width, int height) {
  Image out(width, height);
  TROFFER_CHECK(values.size() == out.pixels.size());
  for (size_t i = 0; i < values.size(); ++i) out.pixels[i] = magma(values[i]);
  return out;
}

Image flip_map(const Image& image, const Image& reference, int threads) {
  return magma_map(flip_errors(image, reference, default_pixels_per_degree, threads), image.width,
                   image.height);
}

Image absolute_difference_map(const Image& image, const Image& reference, float gain) {
  return map_pixels(image, reference, [&](Rgb a, Rgb b) {
    const Rgb d = a - b;
    return Rgb{std::abs(d.r), std::abs(d.g), std::abs(d.b)} * gain;
  });
}

Image signed_difference_map(const Image& image, const Image& reference, float gain) {
  return map_pixels(image, reference, [&](Rgb a, Rgb b) {
    const float d = (luminance(a) - luminance(b)) * gain;
    if (!(std::abs(d) > 0)) return Rgb{0};  // also NaN
    const float v = std::fmin(std::abs(d), 1.0f);
    return d > 0 ? Rgb{v, 0.25f * v, 0} : Rgb{0, 0.25f * v, v};
  });
}

}  // namespace troffer
