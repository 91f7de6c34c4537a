// PNG, JPEG, HDR and PFM: known bytes give known pixels.
#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "image/fixtures.h"
#include "image/float_size.h"
#include "image/raster.h"

using namespace troffer;
using test::make_jpeg;
using test::make_png;
using test::PngFixture;

namespace {

std::vector<uint8_t> bytes_of(const std::string& text) {
  return {text.begin(), text.end()};
}

std::vector<uint8_t> joined(const std::string& text, const std::vector<uint8_t>& rest) {
  std::vector<uint8_t> out = bytes_of(text);
  out.insert(out.end(), rest.begin(), rest.end());
  return out;
}

std::string why_rejected(const std::vector<uint8_t>& bytes, size_t max_pixels = 1 << 20) {
  try {
    decode_raster(bytes, "file", max_pixels);
  } catch (const InputError& e) {
    CHECK(e.file() == "file");
    return e.reason();
  }
  return "";
}

}  // namespace

TEST_CASE("8-bit PNG keeps its bytes, interlaced or not") {
  PngFixture fixture{.width = 19,
                     .height = 11,
                     .colour_type = 6,
                     .rows = {},
                     .palette_rgb = {},
                     .palette_alpha = {}};
  Random random(1);
  std::vector<uint8_t> expected;
  for (int y = 0; y < fixture.height; ++y) {
    std::vector<uint8_t> row;
    for (int i = 0; i < fixture.width * 4; ++i) row.push_back(uint8_t(random.next_u32()));
    expected.insert(expected.end(), row.begin(), row.end());
    fixture.rows.push_back(row);
  }
  for (const bool is_interlaced : {false, true}) {
    fixture.is_interlaced = is_interlaced;
    const Raster raster = decode_raster(make_png(fixture), "file");
    CHECK(raster.width == 19);
    CHECK(raster.height == 11);
    CHECK(raster.channels == 4);
    CHECK(raster.is_srgb);
    CHECK(raster.texels_float.empty());
    CHECK(raster.texels8 == expected);
  }
}

TEST_CASE("16-bit PNG becomes floats in [0,1], interlaced or not") {
  PngFixture fixture{.width = 9,
                     .height = 8,
                     .colour_type = 2,
                     .depth = 16,
                     .rows = {},
                     .palette_rgb = {},
                     .palette_alpha = {}};
  Random random(2);
  std::vector<float> expected;
  for (int y = 0; y < fixture.height; ++y) {
    std::vector<uint8_t> row;
    for (int i = 0; i < fixture.width * 3; ++i) {
      const uint32_t v = y == 0 ? (i % 2 != 0 ? 65535u : 0u) : random.next_u32() >> 16;
      row.push_back(uint8_t(v >> 8));
      row.push_back(uint8_t(v));
      expected.push_back(float(v) / 65535.0f);
    }
    fixture.rows.push_back(row);
  }
  for (const bool is_interlaced : {false, true}) {
    fixture.is_interlaced = is_interlaced;
    const Raster raster = decode_raster(make_png(fixture), "file");
    CHECK(raster.channels == 3);
    CHECK(raster.texels8.empty());
    CHECK(raster.texels_float == expected);
  }
}

TEST_CASE("palettes and few-bit greys are expanded") {
  // Two bits per pixel: the byte holds entries 3 2 1 0.
  const PngFixture palette{.width = 4,
                           .height = 1,
                           .colour_type = 3,
                           .depth = 2,
                           .rows = {{0b11100100}},
                           .palette_rgb = {0, 0, 0, 10, 20, 30, 40, 50, 60, 255, 254, 253},
                           .palette_alpha = {255, 7}};
  const Raster colours = decode_raster(make_png(palette), "file");
  CHECK(colours.channels == 4);
  CHECK(colours.texels8 ==
        std::vector<uint8_t>{255, 254, 253, 255, 40, 50, 60, 255, 10, 20, 30, 7, 0, 0, 0, 255});
  const PngFixture grey{.width = 4,
                        .height = 1,
                        .colour_type = 0,
                        .depth = 2,
                        .rows = {{0b11100100}},
                        .palette_rgb = {},
                        .palette_alpha = {}};
  const Raster greys = decode_raster(make_png(grey), "file");
  CHECK(greys.channels == 1);
  CHECK(greys.texels8 == std::vector<uint8_t>{255, 170, 85, 0});
}

TEST_CASE("JPEG: grey, colour, progressive and Adobe's inverted CMYK") {
  const Raster grey = decode_raster(make_jpeg(16, 8, 1, std::vector<uint8_t>(128, 77)), "file");
  CHECK(grey.channels == 1);
  CHECK(grey.texels8 == std::vector<uint8_t>(128, 77));

  std::vector<uint8_t> samples;
  for (int i = 0; i < 256; ++i) samples.insert(samples.end(), {200, 100, 50});
  for (const bool is_progressive : {false, true}) {
    const Raster colour = decode_raster(make_jpeg(16, 16, 3, samples, is_progressive), "file");
    CHECK(colour.channels == 3);
    CHECK(colour.is_srgb);
    REQUIRE(colour.texels8.size() == samples.size());
    for (size_t i = 0; i < samples.size(); ++i)
      CHECK(std::abs(int(colour.texels8[i]) - int(samples[i])) <= 2);
  }

  samples.clear();  // libjpeg marks CMYK as Adobe's: 255 means no ink
  for (int i = 0; i < 64; ++i) samples.insert(samples.end(), {255, 128, 0, 200});
  const Raster ink = decode_raster(make_jpeg(8, 8, 4, samples), "file");
  CHECK(ink.channels == 3);
  CHECK(std::abs(int(ink.texels8[0]) - 200) <= 2);
  CHECK(std::abs(int(ink.texels8[1]) - 100) <= 2);
  CHECK(std::abs(int(ink.texels8[2]) - 0) <= 2);
}

TEST_CASE("HDR: orientation, exposure, XYZ, old runs") {
  const std::vector<uint8_t> two_pixels{128, 64, 32, 129, 0, 0, 0, 0};
  const Raster plain = decode_raster(joined("#?RADIANCE\n\n-Y 1 +X 2\n", two_pixels), "file");
  CHECK(plain.channels == 3);
  CHECK_FALSE(plain.is_srgb);
  const float step = 2.0f / 256;  // exponent 129
  CHECK(plain.texels_float[0] == doctest::Approx(128.5 * double(step)));
  CHECK(plain.texels_float[2] == doctest::Approx(32.5 * double(step)));
  CHECK(plain.texels_float[3] == 0);

  const std::string exposed = "#?RADIANCE\nEXPOSURE=2\nEXPOSURE= 4\nFORMAT=32-bit_rle_rgbe\n\n";
  CHECK(decode_raster(joined(exposed + "-Y 1 +X 2\n", two_pixels), "file").texels_float[0] ==
        doctest::Approx(128.5 * double(step) / 8));

  // The bright pixel is stored first; its position reveals the orientation.
  const auto bright_at = [&](const std::string& resolution) {
    const Raster r = decode_raster(joined("#?RADIANCE\n\n" + resolution, two_pixels), "file");
    return std::pair(std::pair(r.width, r.height), r.texels_float[0] > 0 ? 0 : 1);
  };
  using std::pair;
  CHECK(bright_at("-Y 1 +X 2\n") == pair(pair(2, 1), 0));
  CHECK(bright_at("-Y 1 -X 2\n") == pair(pair(2, 1), 1));
  CHECK(bright_at("+Y 2 +X 1\n") == pair(pair(1, 2), 1));
  CHECK(bright_at("-Y 2 +X 1\n") == pair(pair(1, 2), 0));
  CHECK(bright_at("+X 2 +Y 1\n") == pair(pair(2, 1), 0));
  CHECK(bright_at("+X 1 +Y 2\n") == pair(pair(1, 2), 1));

  // Equal-energy white in XYZ is reddish in Rec. 709.
  const Raster xyz = decode_raster(
      joined("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n", {128, 128, 128, 129}), "file");
  CHECK(xyz.texels_float[0] > xyz.texels_float[1]);
  CHECK(xyz.texels_float[1] == doctest::Approx(0.9483 * 128.5 / 128).epsilon(0.001));

  // Three pixels: one, then "repeat 2 times".
  const Raster runs =
      decode_raster(joined("#?RADIANCE\n\n-Y 1 +X 3\n", {128, 64, 32, 129, 1, 1, 1, 2}), "file");
  CHECK(runs.texels_float[6] == runs.texels_float[0]);
  CHECK(runs.texels_float[8] == runs.texels_float[2]);
  CHECK(why_rejected(joined("#?RADIANCE\n\n-Y 1 +X 3\n", {128, 64, 32, 129, 1, 1, 1, 3})) != "");
  CHECK(why_rejected(joined("#?RADIANCE\n\n-Y 1 +X 3\n", {1, 1, 1, 3})) != "");
}

TEST_CASE("PFM: both endians, bottom row first, grey") {
  const auto floats = [](const std::vector<float>& values, bool is_big_endian) {
    std::vector<uint8_t> out;
    for (const float v : values) {
      auto bits = std::bit_cast<uint32_t>(v);
      if (is_big_endian) bits = __builtin_bswap32(bits);
      for (int i = 0; i < 4; ++i) out.push_back(uint8_t(bits >> (8 * i)));
    }
    return out;
  };
  for (const bool is_big_endian : {false, true}) {
    const std::string scale = is_big_endian ? "1.0\n" : "-1.0\n";
    const Raster grey =
        decode_raster(joined("Pf\n2 2\n" + scale, floats({1, 2, 3, 4}, is_big_endian)), "file");
    CHECK(grey.channels == 1);
    CHECK(grey.texels_float == std::vector<float>{3, 4, 1, 2});
    const Raster colour =
        decode_raster(joined("PF 1 2 " + scale, floats({1, 2, 3, 4, 5, 6}, is_big_endian)), "file");
    CHECK(colour.channels == 3);
    CHECK(colour.texels_float == std::vector<float>{4, 5, 6, 1, 2, 3});
  }
  CHECK(why_rejected(bytes_of("PF\n2 2\n-1.0\nabcd")) == "truncated PFM");
  CHECK(why_rejected(bytes_of("PF\n-2 2\n-1.0\nabcd")) != "");
  CHECK(why_rejected(bytes_of("PF\n2 2\nnan\nabcd")) != "");
}

TEST_CASE("the pixel limit holds before memory is taken") {
  CHECK(why_rejected(bytes_of("PF\n100000 100000\n-1.0\n")).find("limit") != std::string::npos);
  CHECK(why_rejected(bytes_of("#?RADIANCE\n\n-Y 100000 +X 100000\n")).find("limit") !=
        std::string::npos);
  std::vector<uint8_t> jpeg = make_jpeg(16, 8, 1, std::vector<uint8_t>(128, 77));
  CHECK(why_rejected(jpeg, 128) == "");
  CHECK(why_rejected(jpeg, 127).find("limit") != std::string::npos);
  PngFixture fixture{.width = 4,
                     .height = 1,
                     .colour_type = 0,
                     .rows = {{1, 2, 3, 4}},
                     .palette_rgb = {},
                     .palette_alpha = {}};
  CHECK(why_rejected(make_png(fixture), 4) == "");
  CHECK(why_rejected(make_png(fixture), 3).find("limit") != std::string::npos);
}

TEST_CASE("other files are refused by name") {
  CHECK(why_rejected({}) == "empty file");
  CHECK(why_rejected(bytes_of("P5 2 2 255\nabcd")).find("not a PNG") == 0);
}

TEST_CASE("linear_raster decodes colours and leaves alpha") {
  Raster raster{.width = 1,
                .height = 1,
                .channels = 4,
                .texels8 = {255, 128, 0, 128},
                .texels_float = {},
                .is_srgb = true};
  const Raster linear = linear_raster(raster);
  CHECK(linear.texels8.empty());
  CHECK_FALSE(linear.is_srgb);
  CHECK(linear.texels_float[0] == 1);
  CHECK(linear.texels_float[1] == doctest::Approx(0.21586));
  CHECK(linear.texels_float[3] == doctest::Approx(128.0 / 255));
}

// Floats take at least 12 bytes per pixel, while runs of equal bytes take almost none.
TEST_CASE("a few bytes do not decode to gigabytes") {
  const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
  CHECK(why_rejected(bytes_of(header + "-Y 8000 +X 8000\n"), default_max_pixels)
            .find("picture of 8000x8000 would take 732 MB of memory, from a file of") == 0);
  // 4096 x 4096 is always decoded; here the pixels are missing.
  CHECK(
      why_rejected(bytes_of(header + "-Y 4096 +X 4096\n"), default_max_pixels).find("would take") ==
      std::string::npos);
  Raster grey;
  grey.width = grey.height = 8192;
  grey.channels = 1;
  CHECK_THROWS_WITH_AS(check_float_size(grey, 8000, "file"),
                       doctest::Contains("would take 1024 MB of memory"), InputError);
  CHECK_NOTHROW(check_float_size(grey, 20'000'000, "file"));
  grey.width = grey.height = 4096;
  CHECK_NOTHROW(check_float_size(grey, 8000, "file"));
}
