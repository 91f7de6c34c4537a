#include "image/fixtures.h"

#include <png.h>
#include <unistd.h>

#include <cmath>
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
  if (fixture.gamma > 0) png_set_gAMA(png, info, fixture.gamma);
  if (fixture.is_marked_srgb) png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  if (!fixture.profile.empty())
    png_set_iCCP(png, info, "own", PNG_COMPRESSION_TYPE_BASE, fixture.profile.data(),
                 png_uint_32(fixture.profile.size()));
  std::vector<png_bytep> rows;
  auto copies = fixture.rows;
  for (auto& row : copies) rows.push_back(row.data());
  png_set_rows(png, info, rows.data());
  png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  png_destroy_write_struct(&png, &info);
  return out;
}

namespace {

// Big-endian bytes, as in ICC profiles.
struct ProfileBytes {
  std::vector<uint8_t> bytes{};
  void word(uint32_t v) {
    for (const int shift : {24, 16, 8, 0}) bytes.push_back(uint8_t(v >> shift));
  }
  void fixed(double v) { word(uint32_t(int32_t(std::lround(v * 65536)))); }
  void tag(const char* name) { bytes.insert(bytes.end(), name, name + 4); }
};

struct ProfileTag {
  const char* name;
  std::vector<uint8_t> data;
};

std::vector<uint8_t> xyz_data(const Vec3d& v) {
  ProfileBytes b;
  b.tag("XYZ ");
  b.word(0);
  for (size_t k = 0; k < 3; ++k) b.fixed(v[k]);
  return b.bytes;
}

std::vector<uint8_t> power_data(double power) {
  ProfileBytes b;
  b.tag("curv");
  b.word(0);
  b.word(1);
  const auto fixed = uint32_t(std::lround(power * 256));
  b.word(fixed << 16);  // two bytes and two of padding
  return b.bytes;
}

std::vector<uint8_t> make_profile(const char* space, const std::vector<ProfileTag>& tags) {
  uint32_t at = 128 + 4 + 12 * uint32_t(tags.size());
  ProfileBytes table, data;
  table.word(uint32_t(tags.size()));
  for (const ProfileTag& t : tags) {
    table.tag(t.name);
    table.word(at);
    table.word(uint32_t(t.data.size()));
    data.bytes.insert(data.bytes.end(), t.data.begin(), t.data.end());
    at += uint32_t(t.data.size());
  }
  ProfileBytes out;
  out.word(at);
  out.word(0);
  out.word(0x02400000);  // version 2.4
  for (const char* const name : {"mntr", space, "XYZ "}) out.tag(name);
  for (int i = 0; i < 3; ++i) out.word(0);  // date
  out.tag("acsp");
  for (int i = 0; i < 7; ++i) out.word(0);
  for (const double v : {0.9642, 1.0, 0.8249}) out.fixed(v);
  out.bytes.resize(128);
  out.bytes.insert(out.bytes.end(), table.bytes.begin(), table.bytes.end());
  out.bytes.insert(out.bytes.end(), data.bytes.begin(), data.bytes.end());
  return out.bytes;
}

}  // namespace

std::vector<uint8_t> make_rgb_profile(const std::array<Vec3d, 3>& colorants, double power) {
  return make_profile("RGB ", {{"wtpt", xyz_data({0.9642, 1, 0.8249})},
                               {"rXYZ", xyz_data(colorants[0])},
                               {"gXYZ", xyz_data(colorants[1])},
                               {"bXYZ", xyz_data(colorants[2])},
                               {"rTRC", power_data(power)},
                               {"gTRC", power_data(power)},
                               {"bTRC", power_data(power)}});
}

std::vector<uint8_t> make_grey_profile(double power) {
  return make_profile("GRAY",
                      {{"wtpt", xyz_data({0.9642, 1, 0.8249})}, {"kTRC", power_data(power)}});
}

std::vector<uint8_t> make_jpeg(int width, int height, int components,
                               const std::vector<uint8_t>& samples, bool is_progressive,
                               const std::vector<uint8_t>& profile) {
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
  if (!profile.empty()) jpeg_write_icc_profile(&jpeg, profile.data(), unsigned(profile.size()));
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
