// References: [1] Debevec, "PFM Portable FloatMap Image Format".
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>

#include "image/decode.h"

namespace troffer {

namespace {

bool is_space(uint8_t c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

// Returns the next word of the header; white space separates words.
std::string_view word(const EncodedImage& encoded, size_t& at) {
  const auto bytes = encoded.bytes;
  while (at < bytes.size() && is_space(bytes[at])) ++at;
  const size_t begin = at;
  while (at < bytes.size() && !is_space(bytes[at]) && at - begin < 64) ++at;
  if (at == bytes.size() || !is_space(bytes[at])) encoded.fail("broken PFM header");
  return {reinterpret_cast<const char*>(bytes.data()) + begin, at - begin};
}

template <class T>
T number(const EncodedImage& encoded, size_t& at) {
  const std::string_view text = word(encoded, at);
  T value{};
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size())
    encoded.fail("broken PFM header");
  return value;
}

}  // namespace

bool is_pfm(std::span<const uint8_t> bytes) {
  return bytes.size() >= 3 && bytes[0] == 'P' && (bytes[1] == 'F' || bytes[1] == 'f') &&
         is_space(bytes[2]);
}

// The sign of the scale is the byte order. Its magnitude is a unit that readers ignore.
Raster decode_pfm(const EncodedImage& encoded) {
  size_t at = 2;
  const size_t channels = encoded.bytes[1] == 'F' ? 3 : 1;
  const uint64_t width = number<uint32_t>(encoded, at), height = number<uint32_t>(encoded, at);
  const auto scale = number<float>(encoded, at);
  ++at;  // a single white space before the data
  if (!(std::isfinite(scale) && scale != 0)) encoded.fail("broken PFM header: bad scale");
  encoded.check_size(width, height);
  const size_t row = size_t(width) * channels;
  if ((encoded.bytes.size() - at) / sizeof(float) / row < height) encoded.fail("truncated PFM");

  Raster raster;
  raster.width = int(width);
  raster.height = int(height);
  raster.channels = int(channels);
  raster.texels_float.resize(row * height);
  const bool is_swapped = (scale < 0) != (std::endian::native == std::endian::little);
  for (size_t y = 0; y < height; ++y) {  // the bottom row comes first
    float* out = raster.texels_float.data() + (height - 1 - y) * row;
    std::memcpy(out, encoded.bytes.data() + at + y * row * sizeof(float), row * sizeof(float));
    if (!is_swapped) continue;
    for (size_t i = 0; i < row; ++i)
      out[i] = std::bit_cast<float>(__builtin_bswap32(std::bit_cast<uint32_t>(out[i])));
  }
  return raster;
}

}  // namespace troffer
