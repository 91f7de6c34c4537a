// Decodes picture files of any supported format from memory to arrays of texels. Texture import and
// read_image() use it. Texels keep the file's encoding; linear_raster() and rec709_raster() convert
// them.
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
// Exactly one of `texels8` and `texels_float` is filled. Channels: 1 grey, 2 grey + alpha, 3 rgb, 4
// rgb + alpha. Alpha is straight in PNG, as stored in EXR, and never sRGB encoded.
struct Raster {
  int width = 0, height = 0, channels = 0;
  std::vector<uint8_t> texels8;     // 8-bit files
  std::vector<float> texels_float;  // 16-bit PNG scaled to [0,1]; HDR, PFM, EXR unchanged
  bool is_srgb = false;             // colour channels are sRGB encoded (PNG, JPEG, WebP, BMP, TGA)
  // Primaries of EXR files that state others than Rec. 709.
  std::optional<Primaries> primaries = std::nullopt;
  // Colour information of PNG and JPEG files; texels are as stored until convert_to_srgb().
  OwnColours own = {};

  // Number of channels without alpha.
  size_t colours() const {
    return size_t(channels == 2 || channels == 4 ? channels - 1 : channels);
  }
};

// Default limit on decoded pixels.
constexpr size_t default_max_pixels = size_t(64) << 20;

// Decodes PNG, JPEG, WebP, BMP, TGA, Radiance HDR, PFM or EXR; the content determines the format.
// Throws InputError{name_for_errors, 0, 0, what} for files that are broken, truncated, of another
// format or larger than `max_pixels` pixels. The size is checked before memory is allocated.
//
// - PNG: all colour types, depths and interlacing; tRNS becomes alpha.
// - JPEG: grey, YCbCr, RGB, CMYK and YCCK (Adobe's inverted form too), as rgb. Damage that loses no
//   data (junk between markers) is ignored; missing data is an error.
// - WebP: lossy and lossless, alpha; no animation.
// - TGA: colour, grey and mapped, run lengths, 8 to 32 bits, any origin. The fourth byte is alpha
//   if the header says so.
// - BMP: 1 to 32 bits, mapped, bit fields and run lengths, either row order; alpha if the header
//   has a field for it.
// - HDR: RGBE and XYZE (converted to Rec. 709), old and new run lengths, every orientation of the
//   resolution line. Pixels are divided by the header's EXPOSURE values, as the format requires.
// - PFM: either byte order, colour and grey.
// - EXR: scan lines or tiles (the finest level), any data window (it becomes the picture).
//   Channels R,G,B,A or Y,A or luminance-chroma of the default layer; otherwise the first layer
//   with R, G or B, or the first channel as grey. Of a multi-part file only the first part. Deep
//   data and other subsampled channels are rejected by name.
Raster decode_raster(std::span<const uint8_t> bytes, const std::string& name_for_errors,
                     size_t max_pixels = default_max_pixels);

// Returns the picture with float texels; colour channels are linearised if is_srgb.
Raster linear_raster(Raster raster);

// Returns the picture in Rec. 709, without its own primaries. Either its white stays white, or its
// colours keep their chromaticities. Negative values are kept.
Raster rec709_raster(Raster raster, bool keeps_white);

}  // namespace troffer
