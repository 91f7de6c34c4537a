// Picture files -> linear images.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "image/image.h"
#include "image/raster.h"

namespace troffer {

// The bytes of a file. InputError if it cannot be read, is a folder or is longer than max_bytes.
std::vector<uint8_t> read_file_bytes(const std::string& path, size_t max_bytes = size_t(1) << 31);

// The picture in a file of any format that decode_raster() knows, as linear Rec. 709: 8- and
// 16-bit files are decoded from sRGB, EXR files of other primaries converted, grey is repeated over
// r, g and b, alpha is left out. Values are as they are in the file, NaN included. Errors:
// InputError{path, 0, 0, what}.
Image read_image(const std::string& path, size_t max_pixels = default_max_pixels);

}  // namespace troffer
