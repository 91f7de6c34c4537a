#include <png.h>

#include <csetjmp>
#include <cstring>

#include "image/decode.h"
#include "image/float_size.h"

namespace troffer {

namespace {

// Deflate shrinks data at most by this factor (1032, plus a margin), so a short file cannot claim a
// large picture.
constexpr uint64_t max_deflate_ratio = 1100;
constexpr png_alloc_size_t max_chunk_bytes = 1 << 20;  // not for pixel data
constexpr png_byte colour_chunks[] = "gAMA\0iCCP\0sRGB";

// State shared with libpng's callbacks. It outlives the stack frames that longjmp skips.
struct PngReader {
  const EncodedImage& encoded;
  size_t at = 0;
  std::string error{};
  Raster raster{};
  std::vector<png_bytep> rows{};
};

void on_error(png_structp png, png_const_charp message) {
  static_cast<PngReader*>(png_get_error_ptr(png))->error = message;
  png_longjmp(png, 1);
}
void on_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep out, size_t n) {
  auto& reader = *static_cast<PngReader*>(png_get_io_ptr(png));
  if (n > reader.encoded.bytes.size() - reader.at) png_error(png, "truncated file");
  std::memcpy(out, reader.encoded.bytes.data() + reader.at, n);
  reader.at += n;
}

struct PngHandles {
  png_structp png = nullptr;
  png_infop info = nullptr;
  PngHandles() = default;
  PngHandles(const PngHandles&) = delete;
  PngHandles& operator=(const PngHandles&) = delete;
  ~PngHandles() { png_destroy_read_struct(&png, &info, nullptr); }
};

// Requests 8 or 16 bits of grey, grey + alpha, rgb or rgba from libpng. Returns true for 16.
bool set_transformations(png_structp png, png_infop info) {
  const int colour = png_get_color_type(png, info), depth = png_get_bit_depth(png, info);
  if (colour == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(png);
  if (colour == PNG_COLOR_TYPE_GRAY && depth < 8) png_set_expand_gray_1_2_4_to_8(png);
  if (png_get_valid(png, info, PNG_INFO_tRNS) != 0) png_set_tRNS_to_alpha(png);
  png_set_interlace_handling(png);
  return depth == 16;
}

// sRGB takes precedence over a profile, and a profile over gamma.
void note_colours(png_structp png, png_infop info, OwnColours& own) {
  if (png_get_valid(png, info, PNG_INFO_sRGB) != 0) return;
  png_charp name = nullptr;
  png_bytep profile = nullptr;
  png_uint_32 length = 0;
  int compression = 0;
  if (png_get_iCCP(png, info, &name, &compression, &profile, &length) != 0)
    own.profile.assign(profile, profile + length);
  double gamma = 0;
  if (png_get_gAMA(png, info, &gamma) != 0) own.gamma = float(gamma);
}

// Prepares the row pointers. 16-bit rows are read into the second half of their space in
// texels_float, so that expand16 can widen them in place.
void prepare_rows(PngReader& reader, bool is_16, size_t row_bytes) {
  Raster& raster = reader.raster;
  const auto height = size_t(raster.height);
  reader.rows.resize(height);
  if (is_16) {
    raster.texels_float.resize(row_bytes / 2 * height);
    auto* base = reinterpret_cast<png_bytep>(raster.texels_float.data());
    for (size_t y = 0; y < height; ++y) reader.rows[y] = base + y * 2 * row_bytes + row_bytes;
  } else {
    raster.texels8.resize(row_bytes * height);
    for (size_t y = 0; y < height; ++y) reader.rows[y] = raster.texels8.data() + y * row_bytes;
  }
}

// Converts big-endian 16-bit values in the second half of each row to floats over the whole row.
// Float i ends at byte 4i + 4 and value i + 1 begins at 2n + 2i + 2, which is never earlier for i <
// n.
void expand16(PngReader& reader) {
  const size_t n = size_t(reader.raster.width) * size_t(reader.raster.channels);
  for (size_t y = 0; y < reader.rows.size(); ++y) {
    float* out = reader.raster.texels_float.data() + y * n;
    const png_bytep in = reader.rows[y];
    for (size_t i = 0; i < n; ++i) {
      const int value = in[2 * i] * 256 + in[2 * i + 1];
      out[i] = float(value) / 65535.0f;
    }
  }
}

// All calls that libpng may leave by longjmp. Returns false after an error. This frame must not
// contain objects with destructors.
bool read(PngHandles& handles, PngReader& reader) {
  png_structp png = handles.png;
  png_infop info = handles.info;
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_read_fn(png, &reader, on_read);
  // Ignores all chunks except pixels, transparency and colour information (-1: texts,
  // calibrations): they are not needed and could hide decompression bombs.
  png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
  png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_AS_DEFAULT, colour_chunks, 3);
  png_set_chunk_malloc_max(png, max_chunk_bytes);
  png_read_info(png, info);

  const uint64_t width = png_get_image_width(png, info);
  const uint64_t height = png_get_image_height(png, info);
  reader.encoded.check_size(width, height);
  if (png_get_bit_depth(png, info) == 16)
    check_memory(width, height, png_get_channels(png, info) * sizeof(float),
                 reader.encoded.bytes.size(), reader.encoded.name);
  if (png_get_rowbytes(png, info) * height / max_deflate_ratio > reader.encoded.bytes.size())
    png_error(png, "truncated file");
  note_colours(png, info, reader.raster.own);
  const bool is_16 = set_transformations(png, info);
  png_read_update_info(png, info);
  reader.raster.width = int(width);
  reader.raster.height = int(height);
  reader.raster.channels = png_get_channels(png, info);
  reader.raster.is_srgb = true;
  prepare_rows(reader, is_16, png_get_rowbytes(png, info));
  png_read_image(png, reader.rows.data());
  png_read_end(png, nullptr);
  if (is_16) expand16(reader);
  return true;
}

}  // namespace

bool is_png(std::span<const uint8_t> bytes) {
  return bytes.size() >= 8 && png_sig_cmp(bytes.data(), 0, 8) == 0;
}

Raster decode_png(const EncodedImage& encoded) {
  PngReader reader{encoded};
  PngHandles handles;
  handles.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, on_error, on_warning);
  if (handles.png != nullptr) handles.info = png_create_info_struct(handles.png);
  if (handles.info == nullptr) encoded.fail("cannot start the PNG reader");
  if (!read(handles, reader)) encoded.fail("broken PNG: " + reader.error);
  return std::move(reader.raster);
}

}  // namespace troffer
