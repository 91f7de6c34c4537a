#include "image/float_size.h"

#include "base/error.h"

namespace troffer {

void check_memory(uint64_t width, uint64_t height, uint64_t texel_bytes, size_t file_bytes,
                  const std::string& name) {
  constexpr uint64_t always_allowed = uint64_t(1) << 28, max_ratio = 100;
  const uint64_t needed = width * height * texel_bytes;
  if (needed <= always_allowed || needed / max_ratio <= file_bytes) return;
  throw InputError(name, 0, 0,
                   "picture of " + std::to_string(width) + "x" + std::to_string(height) +
                       " would take " + std::to_string(needed >> 20) +
                       " MB of memory, from a file of " + std::to_string(file_bytes) + " bytes");
}

// Counts the decoded texels as floats and the three-channel image made from them.
void check_float_size(const Raster& raster, size_t file_bytes, const std::string& name) {
  check_memory(uint64_t(raster.width), uint64_t(raster.height),
               (uint64_t(raster.channels) + 3) * sizeof(float), file_bytes, name);
}

}  // namespace troffer
