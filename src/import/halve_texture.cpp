#include "import/halve_texture.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace troffer {

namespace {

// Linear values of an image's bytes, and the byte closest to a value.
struct ByteCode {
  std::array<float, 256> values{};
  bool is_srgb;

  explicit ByteCode(bool is_of_srgb) : is_srgb(is_of_srgb) {
    for (size_t i = 0; i < values.size(); ++i)
      values[i] = is_srgb ? linear_from_srgb(float(i) / 255.0f) : float(i) / 255.0f;
  }
  uint8_t nearest(float value) const {
    const float v = is_srgb ? srgb_from_linear(value) : value;
    return uint8_t(std::lround(std::clamp(v, 0.0f, 1.0f) * 255.0f));
  }
};

// Calls write(index, channel, mean of read(index, channel)) for every channel of every texel of
// `to`, which is half as large as the given size.
template <class Read, class Write>
void average(int from_width, int from_height, const Texture& to, const Read& read,
             const Write& write) {
  const auto n = size_t(to.channels), width = size_t(from_width);
  for (int y = 0; y < to.height; ++y)
    for (int x = 0; x < to.width; ++x)
      for (size_t c = 0; c < n; ++c) {
        float sum = 0;
        int count = 0;
        for (int j = 2 * y; j < std::min(2 * y + 2, from_height); ++j)
          for (int i = 2 * x; i < std::min(2 * x + 2, from_width); ++i, ++count)
            sum += read((size_t(j) * width + size_t(i)) * n + c, c);
        write((size_t(y) * size_t(to.width) + size_t(x)) * n + c, c, sum / float(count));
      }
}

}  // namespace

Texture halved(Texture image) {
  const std::vector<uint8_t> bytes = std::move(image.texels8);
  const std::vector<float> floats = std::move(image.texels_float);
  const int width = image.width, height = image.height;
  Texture small = std::move(image);
  small.width = (width + 1) / 2;
  small.height = (height + 1) / 2;
  const size_t size = size_t(small.width) * size_t(small.height) * size_t(small.channels);
  small.texels8.assign(bytes.empty() ? 0 : size, 0);
  small.texels_float.assign(bytes.empty() ? size : 0, 0);
  if (bytes.empty()) {
    average(
        width, height, small, [&](size_t i, size_t) { return floats[i]; },
        [&](size_t i, size_t, float mean) { small.texels_float[i] = mean; });
    return small;
  }
  const ByteCode color(small.is_srgb), plain(false);
  // Alpha has no transfer function.
  const size_t alpha = small.channels == 2 ? 1 : 3;
  const auto code = [&](size_t c) -> const ByteCode& { return c == alpha ? plain : color; };
  average(
      width, height, small, [&](size_t i, size_t c) { return code(c).values[bytes[i]]; },
      [&](size_t i, size_t c, float mean) { small.texels8[i] = code(c).nearest(mean); });
  return small;
}

}  // namespace troffer
