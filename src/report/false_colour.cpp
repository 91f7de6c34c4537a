#include "report/false_colour.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "image/encode.h"

namespace troffer {

namespace {

// Nodes of the colour scale, evenly spaced; lightness (CIE L*) rises from 15 to 93.
constexpr std::array<std::array<double, 3>, 7> nodes{{{38, 20, 84},
                                                      {52, 70, 140},
                                                      {36, 117, 142},
                                                      {42, 157, 120},
                                                      {122, 192, 74},
                                                      {214, 214, 40},
                                                      {252, 246, 178}}};

double relative_luminance(const Rgb8& c) {
  const auto linear = [](uint8_t v) { return double(linear_from_srgb(float(v) / 255)); };
  return 0.2126 * linear(c[0]) + 0.7152 * linear(c[1]) + 0.0722 * linear(c[2]);
}

// Rounds v up (or down) to 1, 2 or 5 times a power of ten.
double round_to(double v, bool is_up) {
  const double power = std::pow(10.0, std::floor(std::log10(v) + 1e-9));
  const double part = v / power;
  constexpr double slack = 1e-9;
  if (is_up)
    return power * (part <= 1 + slack ? 1 : part <= 2 + slack ? 2 : part <= 5 + slack ? 5 : 10);
  return power * (part >= 5 - slack ? 5 : part >= 2 - slack ? 2 : 1);
}

std::vector<double> by_factors(double least, double largest) {
  std::vector<double> values;
  for (double v = round_to(least, true); v <= largest * (1 + 1e-9) && values.size() < 200;
       v = round_to(v * 1.5, true))
    values.push_back(v);
  return values;
}

}  // namespace

Rgb8 false_colour(double t) {
  const double at = std::clamp(std::isfinite(t) ? t : 0.0, 0.0, 1.0) * double(nodes.size() - 1);
  const auto i = std::min(size_t(at), nodes.size() - 2);
  Rgb8 c;
  for (size_t k = 0; k < 3; ++k)
    c[k] = uint8_t(std::lround(std::lerp(nodes[i][k], nodes[i + 1][k], at - double(i))));
  return c;
}

std::string hex_colour(const Rgb8& c) {
  return fmt::format("#{:02x}{:02x}{:02x}", c[0], c[1], c[2]);
}

bool is_dark(const Rgb8& c) {
  return relative_luminance(c) < 0.2;
}

std::vector<double> round_values(double least, double largest, size_t most, bool is_by_factors) {
  if (!(largest > least && least > 0 && std::isfinite(largest)) || most == 0) return {};
  if (is_by_factors) {
    std::vector<double> values = by_factors(least, largest);
    while (values.size() > most) {  // keep every second value; in the end only powers of ten remain
      std::vector<double> fewer;
      for (size_t i = 0; i < values.size(); i += 2) fewer.push_back(values[i]);
      values = fewer;
    }
    return values;
  }
  const double step = round_to((largest - least) / double(most), true);
  std::vector<double> values;
  for (double k = std::ceil(least / step - 1e-9); k * step <= largest * (1 + 1e-9); ++k)
    values.push_back(k * step);
  return values;
}

LuminanceScale luminance_scale(const Image& image, double unit) {
  std::vector<double> values;
  for (const Rgb& p : image.pixels) {
    const double l = double(luminance(p)) * unit;
    if (std::isfinite(l) && l > 0) values.push_back(l);
  }
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto quantile = [&](double q) { return values[size_t(q * double(values.size() - 1))]; };
  LuminanceScale s{round_to(std::max(quantile(0.02), 1e-6), false),
                   round_to(std::max(quantile(0.998), 1e-6), true)};
  s.largest = std::max(s.largest, 10 * s.least);
  return s;
}

std::vector<uint8_t> false_colour_png(const Image& image, double unit,
                                      const LuminanceScale& scale) {
  std::vector<uint8_t> texels;
  texels.reserve(3 * image.pixels.size());
  for (const Rgb& p : image.pixels) {
    const double l = std::max(double(luminance(p)) * unit, 1e-30);
    const Rgb8 c = false_colour(std::log(l / scale.least) / std::log(scale.largest / scale.least));
    texels.insert(texels.end(), c.begin(), c.end());
  }
  return encode_png_texels(image.width, image.height, 3, std::span<const uint8_t>(texels));
}

}  // namespace troffer
