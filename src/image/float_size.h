// How much memory a picture may take for what its file holds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "image/raster.h"

namespace troffer {

// Throws InputError{name, 0, 0, what} where texels of that many bytes would take more than 256 MB
// and more than a hundred times the file: such a file holds next to nothing, and would exhaust the
// memory.
void check_memory(uint64_t width, uint64_t height, uint64_t texel_bytes, size_t file_bytes,
                  const std::string& name);

// The same for a decoded picture that is to become floats.
void check_float_size(const Raster& raster, size_t file_bytes, const std::string& name);

}  // namespace troffer
