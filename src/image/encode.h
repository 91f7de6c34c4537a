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

std::vector<uint8_t> encode_exr(std::span<const Layer> layers, const ImageWindow& window);
std::vector<uint8_t> encode_hdr(const Image& image);
std::vector<uint8_t> encode_pfm(const Image& image);
std::vector<uint8_t> encode_png(const Image& image, const Display& display, int threads);

}  // namespace troffer
