// Values as colours, and pictures of them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "image/image.h"

namespace troffer {

using Rgb8 = std::array<uint8_t, 3>;

// Dark blue by green to yellow, of evenly rising lightness, for t from 0 to 1 (clamped).
Rgb8 false_colour(double t);
std::string hex_colour(const Rgb8& c);  // "#rrggbb"
// Whether text upon it is to be white.
bool is_dark(const Rgb8& c);

// Values at which a scale is marked: round ones (1, 2, 5 and tenfold), at most `most` from `least`
// to `largest`, both above 0; by equal steps, or (is_by_factors) each 1, 2 or 5 of a power of ten.
std::vector<double> round_values(double least, double largest, size_t most, bool is_by_factors);

// A picture's luminance as false colours, by equal factors from `least` to `largest`, cd/m².
struct LuminanceScale {
  double least = 1, largest = 1000;
};
// Of most of a picture: from its 2 % to its 99.8 % quantile, rounded outward to 1, 2, 5; at least a
// factor of ten.
LuminanceScale luminance_scale(const Image& image, double unit);
// PNG, 8-bit sRGB; `unit`: cd/m² of the image's unit.
std::vector<uint8_t> false_colour_png(const Image& image, double unit, const LuminanceScale& scale);

}  // namespace troffer
