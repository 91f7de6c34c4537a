// The encoders behind write_image(), one per format: pixels -> the bytes of a file. The same
// pixels always give the same bytes.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "image/image.h"
#include "image/tone_map.h"
#include "image/write_image.h"

namespace troffer {

std::vector<uint8_t> encode_exr(std::span<const Layer> layers, const ImageWindow& window,
                                const std::string& note);
std::vector<uint8_t> encode_hdr(const Image& image);
std::vector<uint8_t> encode_pfm(const Image& image);
std::vector<uint8_t> encode_png(const Image& image, const Display& display, int threads);

// Texels as they are, channels interleaved (1 grey, 2 with alpha, 3 rgb, 4 with alpha), row 0 on
// top: of 8 bits, or of numbers in [0,1] at 16 bits.
std::vector<uint8_t> encode_png_texels(int width, int height, int channels,
                                       std::span<const uint8_t> texels);
std::vector<uint8_t> encode_png_texels(int width, int height, int channels,
                                       std::span<const float> texels);

}  // namespace troffer
