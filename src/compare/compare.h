// Compares an image with a reference: means, root mean squared error, 8-bit difference and FLIP.
// The `compare` command and the Python module report these figures. Values are linear and in the
// images' unit unless stated.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "image/image.h"

namespace troffer {

// Figures over all pixels that are finite in both images. Values are linear unless stated.
struct Comparison {
  double mean_image = 0, mean_reference = 0;  // over pixels and channels
  double average_difference = 0;  // mean |difference| of clamped 8-bit sRGB values, 0 to 255
  double rmse = 0;                // root of the mean squared difference over pixels and channels
  double relative_rmse = 0;       // rmse / |mean_reference|; infinite for a black reference
  double flip = 0;                // mean LDR-FLIP (flip.h), 67 pixels per degree
  size_t compared_pixels = 0, non_finite_pixels = 0;
};

// Throws InputError{image_name, 0, 0, what} if the sizes differ or no pixel is finite in both. The
// result does not depend on `threads`.
Comparison compare_images(const Image& image, const Image& reference, const std::string& image_name,
                          int threads = 0);

}  // namespace troffer
