#include "image/read_image.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "base/error.h"
#include "base/similar_file.h"
#include "image/float_size.h"

namespace troffer {

std::vector<uint8_t> read_file_bytes(const std::string& path, size_t max_bytes) {
  const auto fail = [&](const std::string& what) { throw InputError(path, 0, 0, what); };
  const auto close = [](std::FILE* f) { std::fclose(f); };
  const std::unique_ptr<std::FILE, decltype(close)> file(std::fopen(path.c_str(), "rb"), close);
  if (!file && errno == ENOENT)
    throw InputError(path, -1, -1, "cannot open: no such file" + did_you_mean_file(path));
  if (!file) fail("cannot open: " + std::generic_category().message(errno));
  std::vector<uint8_t> bytes;
  constexpr size_t block = size_t(1) << 18;
  for (;;) {
    const size_t at = bytes.size();
    bytes.resize(at + block);
    const size_t n = std::fread(bytes.data() + at, 1, block, file.get());
    bytes.resize(at + n);
    if (bytes.size() > max_bytes)
      fail("longer than the limit of " + std::to_string(max_bytes) + " bytes");
    if (n == block) continue;
    if (std::ferror(file.get()) != 0)
      fail("cannot read: " + std::generic_category().message(errno));
    return bytes;
  }
}

Image read_image(const std::string& path, size_t max_pixels) {
  const std::vector<uint8_t> bytes = read_file_bytes(path);
  Raster decoded = decode_raster(bytes, path, max_pixels);
  check_float_size(decoded, bytes.size(), path);
  const Raster raster = rec709_raster(linear_raster(std::move(decoded)), false);
  Image image(raster.width, raster.height);
  const auto channels = size_t(raster.channels);
  const float* texel = raster.texels_float.data();
  for (Rgb& pixel : image.pixels) {
    pixel = channels >= 3 ? Rgb{texel[0], texel[1], texel[2]} : Rgb{texel[0]};
    texel += channels;
  }
  return image;
}

}  // namespace troffer
