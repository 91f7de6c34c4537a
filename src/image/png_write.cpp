#include <png.h>

#include <csetjmp>

#include "base/error.h"
#include "image/encode.h"

namespace troffer {

namespace {

struct PngWriter {
  std::vector<uint8_t> bytes{};
  std::string error{};
};

void on_error(png_structp png, png_const_charp message) {
  static_cast<PngWriter*>(png_get_error_ptr(png))->error = message;
  png_longjmp(png, 1);
}
void on_warning(png_structp, png_const_charp) {}
void on_write(png_structp png, png_bytep data, size_t n) {
  auto& bytes = static_cast<PngWriter*>(png_get_io_ptr(png))->bytes;
  bytes.insert(bytes.end(), data, data + n);
}
void on_flush(png_structp) {}

// False after an error. No object with a destructor lives in this frame, which libpng may jump
// out of.
bool write(png_structp png, png_infop info, PngWriter& writer, png_uint_32 width,
           png_uint_32 height, const uint8_t* rgb) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, &writer, on_write, on_flush);
  png_set_IHDR(png, info, width, height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_RELATIVE);
  png_write_info(png, info);
  for (png_uint_32 y = 0; y < height; ++y) png_write_row(png, rgb + size_t(y) * width * 3);
  png_write_end(png, nullptr);
  return true;
}

}  // namespace

std::vector<uint8_t> encode_png(const Image& image, const Display& display, int threads) {
  const std::vector<uint8_t> rgb = srgb8(image, display, threads);
  PngWriter writer;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &writer, on_error, on_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  const bool is_written = info != nullptr && write(png, info, writer, png_uint_32(image.width),
                                                   png_uint_32(image.height), rgb.data());
  png_destroy_write_struct(&png, &info);
  if (!is_written) throw EnvironmentError("cannot encode PNG: " + writer.error);
  return std::move(writer.bytes);
}

}  // namespace troffer
