/// @file
/// Pictures as arrays of linear light. Functions read, write and compare them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "troffer/error.h"
#include "troffer/types.h"

namespace troffer::api {

/// A picture of linear light.
struct Image {
  int width = 0;                ///< columns
  int height = 0;               ///< rows
  std::vector<float> pixels{};  ///< height × width × 3 numbers: red, green, blue; row 0 on top
};

/// Conversion of light to display values, for 8-bit pictures.
struct DisplayOptions {
  std::optional<double> exposure{};  ///< stops, -60 to 60; none: from the picture's brightness
  bool is_filmic = true;  ///< applies a filmic tone map; if false, clamps values to [0, 1]
};

/// Differences between a picture and a reference, over the pixels that are finite in both.
struct ImageDifference {
  double mean_image = 0;              ///< mean over pixels and channels, linear
  double mean_reference = 0;          ///< mean over pixels and channels, linear
  double average_difference = 0;      ///< mean absolute difference of 8-bit sRGB values, 0 to 255
  double rmse = 0;                    ///< root mean square difference, linear
  double relative_rmse = 0;           ///< rmse divided by the absolute mean of the reference
  double flip = 0;                    ///< mean LDR-FLIP at 67 pixels per degree
  std::size_t compared_pixels = 0;    ///< pixels that are finite in both pictures
  std::size_t non_finite_pixels = 0;  ///< pixels that are left out of the comparison
};

/// Reads a picture file: PNG, JPEG, WebP, TGA, BMP (decoded from sRGB), HDR, PFM or EXR.
/// @throws InputError if the file cannot be used
Image read_image(const std::string& path);

/// Writes a picture file: .png (converted by `display`), or .exr, .hdr or .pfm (linear).
/// @throws UsageError for another file name extension, for an array whose size is not
///   width × height × 3, and for an exposure outside its range
/// @throws EnvironmentError if the file cannot be written
void write_image(const std::string& path, const Image& image, const DisplayOptions& display = {});

/// Compares a picture with a reference of the same size.
/// @throws InputError if the sizes differ or no pixel is finite in both
ImageDifference compare_images(const Image& image, const Image& reference);

}  // namespace troffer::api
