#include "image/fixtures.h"

#include <png.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include <jpeglib.h>

namespace troffer::test {

namespace fs = std::filesystem;

namespace {

void append(png_structp png, png_bytep data, size_t n) {
  auto& out = *static_cast<std::vector<uint8_t>*>(png_get_io_ptr(png));
  out.insert(out.end(), data, data + n);
}

}  // namespace

std::vector<uint8_t> make_png(const PngFixture& fixture) {
  std::vector<uint8_t> out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(png, &out, append, nullptr);
  png_set_IHDR(png, info, png_uint_32(fixture.width), png_uint_32(fixture.height), fixture.depth,
               fixture.colour_type, fixture.is_interlaced ? PNG_INTERLACE_ADAM7 : 0, 0, 0);
  std::vector<png_color> palette;
  for (size_t i = 0; i + 2 < fixture.palette_rgb.size(); i += 3)
    palette.push_back(
        {fixture.palette_rgb[i], fixture.palette_rgb[i + 1], fixture.palette_rgb[i + 2]});
  if (!palette.empty()) png_set_PLTE(png, info, palette.data(), int(palette.size()));
  if (!fixture.palette_alpha.empty())
    png_set_tRNS(png, info, fixture.palette_alpha.data(), int(fixture.palette_alpha.size()),
                 nullptr);
  std::vector<png_bytep> rows;
  auto copies = fixture.rows;
  for (auto& row : copies) rows.push_back(row.data());
  png_set_rows(png, info, rows.data());
  png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  png_destroy_write_struct(&png, &info);
  return out;
}

std::vector<uint8_t> make_jpeg(int width, int height, int components,
                               const std::vector<uint8_t>& samples, bool is_progressive) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* buffer = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &buffer, &size);
  jpeg.image_width = JDIMENSION(width);
  jpeg.image_height = JDIMENSION(height);
  jpeg.input_components = components;
  jpeg.in_color_space = components == 1 ? JCS_GRAYSCALE : components == 3 ? JCS_RGB : JCS_CMYK;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 100, TRUE);
  if (is_progressive) jpeg_simple_progression(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  auto copy = samples;
  while (jpeg.next_scanline < jpeg.image_height) {
    JSAMPROW row = copy.data() + size_t(jpeg.next_scanline) * size_t(width * components);
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  std::vector<uint8_t> out(buffer, buffer + size);
  jpeg_destroy_compress(&jpeg);
  std::free(buffer);
  return out;
}

Image random_image(int width, int height, uint64_t seed) {
  Random random(seed);
  Image image(width, height);
  for (Rgb& p : image.pixels)
    p = Rgb{random.next_float(), random.next_float(), random.next_float()} * 4.0f;
  return image;
}

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (fs::temp_directory_path() / "troffer-test-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("mkdtemp");
  folder_ = pattern;
}
TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}
size_t TemporaryFolder::entries() const {
  size_t n = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder_)) ++n;
  return n;
}

}  // namespace troffer::test
