// Pictures of the differences of two images, which the `compare` command writes. All results are
// linear images.
// References: [1] Smith & van der Walt, "A Better Default Colormap for Matplotlib", SciPy 2015
//   (the colour map "magma", released under CC0).
#pragma once

#include <vector>

#include "image/image.h"

namespace troffer {

// Returns the colour of a value in [0,1] (clamped; NaN is 0) in magma [1]: black, purple, orange,
// pale yellow. It interpolates nine entries of the table linearly in sRGB. Lightness rises with the
// value. The result is linear, so that writing it without tone map shows these colours.
Rgb magma(float value);

// Returns an image of width x height values, row-major, in magma's colours.
Image magma_map(const std::vector<float>& values, int width, int height);

// Returns the FLIP error of each pixel in magma's colours. Sizes must be equal.
Image flip_map(const Image& image, const Image& reference, int threads = 0);

// Returns |image - reference| per channel, linear, times gain. Sizes must be equal.
Image absolute_difference_map(const Image& image, const Image& reference, float gain = 1);

// Shows where the image is brighter (red) or darker (blue) than the reference: the difference of
// luminance times gain, clamped to [-1,1]. Equal pixels are black. Sizes must be equal.
Image signed_difference_map(const Image& image, const Image& reference, float gain = 1);

}  // namespace troffer
