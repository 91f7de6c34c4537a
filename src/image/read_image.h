// Reads whole files, and picture files as linear Rec. 709 images. Commands use it for references,
// pictures and solutions. See raster.h for textures, whose encoding and alpha matter.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "image/image.h"
#include "image/raster.h"

namespace troffer {

// Returns the bytes of a file. Throws InputError if it cannot be read, is a folder or exceeds
// max_bytes.
std::vector<uint8_t> read_file_bytes(const std::string& path, size_t max_bytes = size_t(1) << 31);

// Returns the picture in a file of any format of decode_raster(), as linear Rec. 709. 8- and 16-bit
// files are decoded from sRGB, and EXR files of other primaries are converted. Grey is repeated
// over r, g and b; alpha is dropped. Values are kept, NaN included. Throws InputError{path, 0, 0,
// what}.
Image read_image(const std::string& path, size_t max_pixels = default_max_pixels);

}  // namespace troffer
