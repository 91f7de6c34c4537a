// Encoders behind write_image(), one per format: from pixels to the bytes of a file. Exporters and
// the baker also call them directly. Equal pixels give equal bytes. Images are linear; rows run
// from the top.
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

// Encode texels unchanged, channels interleaved (1 grey, 2 grey + alpha, 3 rgb, 4 rgb + alpha), row
// 0 on top: 8-bit texels, or values in [0,1] as 16 bits.
std::vector<uint8_t> encode_png_texels(int width, int height, int channels,
                                       std::span<const uint8_t> texels);
std::vector<uint8_t> encode_png_texels(int width, int height, int channels,
                                       std::span<const float> texels);

}  // namespace troffer
