// Pictures of differences.
// References: [1] Smith & van der Walt, "A Better Default Colormap for Matplotlib", SciPy 2015
//   (the colour map "magma", released under CC0).
#pragma once

#include <vector>

#include "image/image.h"

namespace troffer {

// A value in [0,1] (clamped; NaN is 0) in the colours of magma [1], black over purple and orange to
// pale yellow, by nine colours of its table with linear interpolation in sRGB. Lightness rises
// with the value. The result is linear, so that writing it without tone map shows these colours.
Rgb magma(float value);

// Values of width x height pixels, row-major, in magma's colours.
Image magma_map(const std::vector<float>& values, int width, int height);

// The FLIP error of each pixel in magma's colours. Sizes must be equal (else a bug).
Image flip_map(const Image& image, const Image& reference, int threads = 0);

// |image - reference| per channel, linear, times gain. Sizes must be equal (else a bug).
Image absolute_difference_map(const Image& image, const Image& reference, float gain = 1);

// Where the image is brighter (red) or darker (blue) than the reference, by the difference of
// luminance times gain, clamped to [-1,1]; equal is black. Sizes must be equal (else a bug).
Image signed_difference_map(const Image& image, const Image& reference, float gain = 1);

}  // namespace troffer
