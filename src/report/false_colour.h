// Shows values as colours, and images as false-colour pictures.
// Grid plots, plans and luminance pictures of reports use the same scale of colours.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "image/image.h"

namespace troffer {

using Rgb8 = std::array<uint8_t, 3>;

// Returns the colour of t in 0..1 (clamped): dark blue over green to yellow, with evenly rising
// lightness.
Rgb8 false_colour(double t);
std::string hex_colour(const Rgb8& c);  // "#rrggbb"
// True if text on this colour should be white.
bool is_dark(const Rgb8& c);

// Returns round values (1, 2 or 5 times a power of ten) for the marks of a scale: at most `most` of
// them, from `least` to `largest`, both above 0. is_by_factors: each value is round; else they lie
// at equal round steps.
std::vector<double> round_values(double least, double largest, size_t most, bool is_by_factors);

// Logarithmic scale of luminance, cd/m².
struct LuminanceScale {
  double least = 1, largest = 1000;
};
// Returns a scale from the 2 % to the 99.8 % quantile of the picture's luminance, rounded outward
// to 1, 2 or 5 times a power of ten. It spans at least a factor of ten. unit: cd/m² per unit of the
// image.
LuminanceScale luminance_scale(const Image& image, double unit);
// Returns a PNG, 8-bit sRGB. unit: cd/m² per unit of the image.
std::vector<uint8_t> false_colour_png(const Image& image, double unit, const LuminanceScale& scale);

}  // namespace troffer
