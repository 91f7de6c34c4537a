#include <webp/decode.h>

#include "image/decode.h"

namespace troffer {

bool is_webp(std::span<const uint8_t> bytes) {
  const auto has = [&](size_t at, const char(&tag)[5]) {
    for (size_t i = 0; i < 4; ++i)
      if (bytes[at + i] != static_cast<uint8_t>(tag[i])) return false;
    return true;
  };
  return bytes.size() >= 12 && has(0, "RIFF") && has(8, "WEBP");
}

Raster decode_webp(const EncodedImage& encoded) {
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(encoded.bytes.data(), encoded.bytes.size(), &features) != VP8_STATUS_OK)
    encoded.fail("broken WebP: its header cannot be read");
  if (features.has_animation != 0) encoded.fail("animated WebP pictures are not supported");
  if (features.width <= 0 || features.height <= 0) encoded.fail("broken WebP: no pixels");
  encoded.check_size(uint64_t(features.width), uint64_t(features.height));

  Raster raster;
  raster.width = features.width;
  raster.height = features.height;
  raster.channels = features.has_alpha != 0 ? 4 : 3;
  raster.is_srgb = true;
  const size_t stride = size_t(raster.width) * size_t(raster.channels);
  raster.texels8.resize(stride * size_t(raster.height));
  const auto decode = features.has_alpha != 0 ? WebPDecodeRGBAInto : WebPDecodeRGBInto;
  if (decode(encoded.bytes.data(), encoded.bytes.size(), raster.texels8.data(),
             raster.texels8.size(), int(stride)) == nullptr)
    encoded.fail("broken WebP: the picture is damaged or cut short");
  return raster;
}

}  // namespace troffer
