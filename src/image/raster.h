// Encoded picture files held in memory -> arrays of texels, whatever the format.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/primaries.h"
#include "image/own_colours.h"

namespace troffer {

// Decoded texels, row 0 on top, channels interleaved: element (y * width + x) * channels + c.
// Exactly one of `texels8` and `texels_float` is filled. Channels: 1 grey, 2 grey + alpha, 3 rgb,
// 4 rgb + alpha (alpha is straight in PNG, as stored in EXR, and never sRGB encoded).
struct Raster {
  int width = 0, height = 0, channels = 0;
  std::vector<uint8_t> texels8;     // 8-bit files
  std::vector<float> texels_float;  // 16-bit PNG scaled to [0,1]; HDR, PFM and EXR as they are
  bool is_srgb = false;             // colour channels are sRGB encoded (PNG, JPEG, WebP, BMP, TGA)
  // Of EXR files that say so and have others than Rec. 709: what their colours are made of.
  std::optional<Primaries> primaries = std::nullopt;
  // What PNG and JPEG files say; the texels are as stored until obey_own_colours().
  OwnColours own = {};

  // Channels but alpha.
  size_t colours() const {
    return size_t(channels == 2 || channels == 4 ? channels - 1 : channels);
  }
};

// The most pixels that readers decode unless told otherwise.
constexpr size_t default_max_pixels = size_t(64) << 20;

// Decodes PNG, JPEG, WebP, BMP, TGA, Radiance HDR, PFM or EXR, told apart by content. A file that
// is broken, truncated, of another format or of more than `max_pixels` pixels throws
// InputError{name_for_errors, 0, 0, what}; the size is checked before memory is taken.
//
// PNG: all colour types, depths and interlacing; tRNS becomes alpha.
// JPEG: grey, YCbCr, RGB, CMYK and YCCK (Adobe's inverted form too), as rgb; damage that costs no
//   data (junk between markers) is forgiven, missing data is not.
// WebP: lossy and lossless, alpha; not animated. TGA: colour, grey and mapped, run lengths, 8 to 32
//   bits, any origin; the fourth byte is alpha where the header says so.
// BMP: 1 to 32 bits, mapped, bit fields and run lengths, either order of rows; alpha where the
// header
//   has a field for it.
// HDR: RGBE and XYZE (converted to Rec. 709), old and new run lengths, every orientation of the
//   resolution line; pixels are divided by the header's EXPOSURE values, as the format asks.
// PFM: both endians, colour and grey.
// EXR: scan lines or tiles (the finest level), any data window (the picture is the data window);
//   R,G,B,A or Y,A or luminance-chroma of the default layer; failing those the first layer that
//   has R, G or B, else the first channel as grey. Of a multi-part file the first part. Deep data
//   and other subsampled channels are refused by name.
Raster decode_raster(std::span<const uint8_t> bytes, const std::string& name_for_errors,
                     size_t max_pixels = default_max_pixels);

// The same picture with float texels and, where is_srgb, linear colour channels.
Raster linear_raster(Raster raster);

// The same picture in Rec. 709, and without primaries of its own: its white stays white, or colours
// stay the lights that they are. Negative values are left as they are.
Raster rec709_raster(Raster raster, bool keeps_white);

}  // namespace troffer
