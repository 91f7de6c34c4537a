// Limits the memory of a decoded picture relative to the size of its file, so that a small
// malicious file cannot exhaust memory. Picture readers call it before they allocate. Sizes are in
// bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "image/raster.h"

namespace troffer {

// Throws InputError{name, 0, 0, what} if texels of this size need over 256 MB and over a hundred
// times the file. Such a file contains almost no information and would exhaust the memory.
void check_memory(uint64_t width, uint64_t height, uint64_t texel_bytes, size_t file_bytes,
                  const std::string& name);

// Same for a decoded picture that is converted to floats.
void check_float_size(const Raster& raster, size_t file_bytes, const std::string& name);

}  // namespace troffer
