// Decoders behind decode_raster(), one per format. Each takes a whole file, checks the size against
// max_pixels before it allocates memory, and throws InputError for any defect. The is_png() and
// similar functions test a file's first bytes.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "base/error.h"
#include "image/raster.h"

namespace troffer {

// Input of every decoder.
struct EncodedImage {
  std::span<const uint8_t> bytes;
  const std::string& name;  // for errors
  size_t max_pixels;

  [[noreturn]] void fail(const std::string& what) const { throw InputError(name, 0, 0, what); }
  // Throws unless 1 <= width * height <= max_pixels and both fit an int.
  void check_size(uint64_t width, uint64_t height) const;
};

bool is_png(std::span<const uint8_t> bytes);
bool is_jpeg(std::span<const uint8_t> bytes);
bool is_hdr(std::span<const uint8_t> bytes);
bool is_pfm(std::span<const uint8_t> bytes);
bool is_exr(std::span<const uint8_t> bytes);
bool is_webp(std::span<const uint8_t> bytes);
bool is_bmp(std::span<const uint8_t> bytes);
bool is_tga(std::span<const uint8_t> bytes);  // heuristic: test it last

Raster decode_png(const EncodedImage& encoded);
Raster decode_jpeg(const EncodedImage& encoded);
Raster decode_hdr(const EncodedImage& encoded);
Raster decode_pfm(const EncodedImage& encoded);
Raster decode_exr(const EncodedImage& encoded);
Raster decode_webp(const EncodedImage& encoded);
Raster decode_bmp(const EncodedImage& encoded);
Raster decode_tga(const EncodedImage& encoded);

}  // namespace troffer
