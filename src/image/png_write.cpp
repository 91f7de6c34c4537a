#include <png.h>

#include <algorithm>
#include <cmath>
#include <csetjmp>

#include "base/error.h"
#include "image/encode.h"

namespace troffer {

namespace {

struct PngWriter {
  std::vector<uint8_t> bytes{};
  std::string error{};
};

struct PngRows {
  png_uint_32 width, height;
  int bits, color_type;
  bool is_srgb;
  const uint8_t* bytes;
  size_t row_bytes;
};

void on_write_error(png_structp png, png_const_charp message) {
  static_cast<PngWriter*>(png_get_error_ptr(png))->error = message;
  png_longjmp(png, 1);
}
void on_write_warning(png_structp, png_const_charp) {}
void on_write(png_structp png, png_bytep data, size_t n) {
  auto& bytes = static_cast<PngWriter*>(png_get_io_ptr(png))->bytes;
  bytes.insert(bytes.end(), data, data + n);
}
void on_flush(png_structp) {}

// Returns false after an error. libpng may leave this frame by longjmp, so it must not contain
// objects with destructors.
bool write(png_structp png, png_infop info, PngWriter& writer, const PngRows& rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, &writer, on_write, on_flush);
  png_set_IHDR(png, info, rows.width, rows.height, rows.bits, rows.color_type, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (rows.is_srgb) png_set_sRGB(png, info, PNG_sRGB_INTENT_RELATIVE);
  png_write_info(png, info);
  for (png_uint_32 y = 0; y < rows.height; ++y)
    png_write_row(png, rows.bytes + size_t(y) * rows.row_bytes);
  png_write_end(png, nullptr);
  return true;
}

std::vector<uint8_t> encode(const PngRows& rows) {
  PngWriter writer;
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, &writer, on_write_error, on_write_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  const bool is_written = info != nullptr && write(png, info, writer, rows);
  png_destroy_write_struct(&png, &info);
  if (!is_written) throw EnvironmentError("cannot encode PNG: " + writer.error);
  return std::move(writer.bytes);
}

int color_type_of(int channels) {
  return channels == 1   ? PNG_COLOR_TYPE_GRAY
         : channels == 2 ? PNG_COLOR_TYPE_GRAY_ALPHA
         : channels == 3 ? PNG_COLOR_TYPE_RGB
                         : PNG_COLOR_TYPE_RGB_ALPHA;
}

}  // namespace

std::vector<uint8_t> encode_png(const Image& image, const Display& display, int threads) {
  const std::vector<uint8_t> rgb = srgb8(image, display, threads);
  return encode({png_uint_32(image.width), png_uint_32(image.height), 8, PNG_COLOR_TYPE_RGB, true,
                 rgb.data(), size_t(image.width) * 3});
}

std::vector<uint8_t> encode_png_texels(int width, int height, int channels,
                                       std::span<const uint8_t> texels) {
  return encode({png_uint_32(width), png_uint_32(height), 8, color_type_of(channels), false,
                 texels.data(), size_t(width) * size_t(channels)});
}

std::vector<uint8_t> encode_png_texels(int width, int height, int channels,
                                       std::span<const float> texels) {
  std::vector<uint8_t> bytes;
  bytes.reserve(texels.size() * 2);
  for (const float v : texels) {
    const auto n = unsigned(std::lround(65535 * std::clamp(v, 0.0f, 1.0f)));
    bytes.push_back(uint8_t(n >> 8));
    bytes.push_back(uint8_t(n & 255));
  }
  return encode({png_uint_32(width), png_uint_32(height), 16, color_type_of(channels), false,
                 bytes.data(), size_t(width) * size_t(channels) * 2});
}

}  // namespace troffer
