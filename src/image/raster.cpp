#include "image/raster.h"

#include <array>
#include <limits>
#include <new>
#include <utility>

#include "base/rgb.h"
#include "image/decode.h"

namespace troffer {

void EncodedImage::check_size(uint64_t width, uint64_t height) const {
  constexpr auto int_max = uint64_t(std::numeric_limits<int>::max());
  if (width == 0 || height == 0) fail("picture without pixels");
  if (width > int_max || height > int_max || width > max_pixels / height)
    fail("picture of " + std::to_string(width) + "x" + std::to_string(height) +
         " exceeds the limit of " + std::to_string(max_pixels) + " pixels");
}

Raster decode_raster(std::span<const uint8_t> bytes, const std::string& name_for_errors,
                     size_t max_pixels) {
  const EncodedImage encoded{bytes, name_for_errors, max_pixels};
  try {
    if (is_png(bytes)) return decode_png(encoded);
    if (is_jpeg(bytes)) return decode_jpeg(encoded);
    if (is_exr(bytes)) return decode_exr(encoded);
    if (is_hdr(bytes)) return decode_hdr(encoded);
    if (is_pfm(bytes)) return decode_pfm(encoded);
    if (is_webp(bytes)) return decode_webp(encoded);
    if (is_bmp(bytes)) return decode_bmp(encoded);
    if (is_tga(bytes)) return decode_tga(encoded);
  } catch (const std::bad_alloc&) {
    encoded.fail("not enough memory to decode this picture");
  }
  encoded.fail(bytes.empty()
                   ? "empty file"
                   : "not a PNG, JPEG, WebP, BMP, TGA, Radiance HDR, PFM or OpenEXR picture");
}

Raster linear_raster(Raster raster) {
  std::array<float, 256> linear{};
  for (size_t i = 0; i < linear.size(); ++i)
    linear[i] = raster.is_srgb ? linear_from_srgb(float(i) / 255) : float(i) / 255;
  const auto channels = size_t(raster.channels);
  const size_t colours = raster.colours();
  if (!raster.texels8.empty()) {
    raster.texels_float.resize(raster.texels8.size());
    for (size_t i = 0; i < raster.texels8.size(); ++i) {
      const uint8_t v = raster.texels8[i];
      raster.texels_float[i] = i % channels < colours ? linear[v] : float(v) / 255;
    }
    raster.texels8 = {};
  } else if (raster.is_srgb) {
    for (size_t i = 0; i < raster.texels_float.size(); ++i)
      if (i % channels < colours) raster.texels_float[i] = linear_from_srgb(raster.texels_float[i]);
  }
  raster.is_srgb = false;
  return raster;
}

Raster rec709_raster(Raster raster, bool keeps_white) {
  if (!raster.primaries || raster.channels < 3) return raster;
  const Affine matrix = srgb_from(*raster.primaries, keeps_white);
  const auto channels = size_t(raster.channels);
  for (size_t i = 0; i + 2 < raster.texels_float.size(); i += channels) {
    float* const texel = &raster.texels_float[i];
    const Vec3d c = matrix.vector({texel[0], texel[1], texel[2]});
    for (size_t k = 0; k < 3; ++k) texel[k] = float(c[k]);
  }
  raster.primaries.reset();
  return raster;
}

}  // namespace troffer
