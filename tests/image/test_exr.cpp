// EXR files as other programs write them, and our own layers.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "base/error.h"
#include "base/rgb.h"
#include "image/exr_fixture.h"
#include "image/fixtures.h"
#include "image/read_image.h"
#include "image/write_image.h"

using namespace troffer;
using test::exr_value;
using test::ExrFixture;
using test::ExrType;
using test::make_exr;
using test::random_image;
using test::TemporaryFolder;

TEST_CASE("scan lines and tiles of half, float and uint, anywhere, in any order") {
  for (const auto type : {ExrType::half, ExrType::floating, ExrType::uint})
    for (const int tile : {0, 16})
      for (const bool is_decreasing : {false, true})
        for (const int offset : {0, -25, 400}) {
          ExrFixture f;
          f.type = type;
          f.tile_width = tile;
          f.tile_height = 2 * tile;
          f.is_decreasing = is_decreasing;
          f.x = offset;
          f.y = 2 * offset;
          const Raster raster = decode_raster(make_exr(f), "file");
          REQUIRE(raster.width == f.width);
          REQUIRE(raster.height == f.height);
          REQUIRE(raster.channels == 3);
          int wrong = 0;
          const float* texel = raster.texels_float.data();
          for (int y = 0; y < f.height; ++y)
            for (int x = 0; x < f.width; ++x)
              for (size_t c = 0; c < 3; ++c) wrong += *texel++ != exr_value(2 - c, x, y);
          CHECK(wrong == 0);
        }
}

TEST_CASE("which channels make the picture") {
  ExrFixture f;
  const auto raster_of = [&](const std::vector<std::string>& channels) {
    f.channels = channels;
    return decode_raster(make_exr(f), "file");
  };
  const auto last = [](const Raster& r, size_t c) {
    return r.texels_float[r.texels_float.size() - size_t(r.channels) + c];
  };
  const auto expected = [](size_t channel) { return exr_value(channel, 69, 49); };

  const Raster rgba = raster_of({"A", "B", "G", "R", "Z", "albedo.R"});
  CHECK(rgba.channels == 4);
  CHECK(last(rgba, 0) == expected(3));
  CHECK(last(rgba, 3) == expected(0));
  const Raster red = raster_of({"R"});  // missing channels are 0
  CHECK(red.channels == 3);
  CHECK(last(red, 0) == expected(0));
  CHECK(last(red, 1) == 0);
  const Raster grey = raster_of({"A", "Y"});
  CHECK(grey.channels == 2);
  CHECK(last(grey, 0) == expected(1));
  const Raster layer = raster_of({"depth.Z", "diffuse.B", "diffuse.G", "diffuse.R"});
  CHECK(layer.channels == 3);
  CHECK(last(layer, 0) == expected(3));
  const Raster depth = raster_of({"Z"});
  CHECK(depth.channels == 1);
  CHECK(last(depth, 0) == expected(0));
}

TEST_CASE("luminance and subsampled chroma become colour; other subsampling is refused") {
  // rgb (2, 1, 0): Y = 0.2126 * 2 + 0.7152, RY = (R - Y) / Y, BY = (B - Y) / Y.
  const float y = 0.2126f * 2 + 0.7152f;
  ExrFixture f;
  f.type = ExrType::floating;
  f.channels = {"BY", "RY", "Y"};
  f.constants = {-1, (2 - y) / y, y};
  f.sampling = {2, 2, 1};
  for (const int offset : {0, -20, 300}) {
    f.x = f.y = offset;
    const Raster raster = decode_raster(make_exr(f), "file");
    REQUIRE(raster.channels == 3);
    for (const size_t i : {size_t(0), size_t(70 * 25 + 35), size_t(70 * 50 - 1)}) {
      CHECK(raster.texels_float[3 * i] == doctest::Approx(2).epsilon(0.005));
      CHECK(raster.texels_float[3 * i + 1] == doctest::Approx(1).epsilon(0.005));
      CHECK(std::abs(raster.texels_float[3 * i + 2]) < 0.005f);
    }
  }
  f.channels = {"B", "G", "R"};
  CHECK_THROWS_WITH_AS(decode_raster(make_exr(f), "file"),
                       "file:1:1: EXR with subsampled channel G is not supported", InputError);
}

TEST_CASE("headers that claim too much are refused before OpenEXR reads them") {
  const auto reason = [](const ExrFixture& f, int claimed_width, int claimed_height) {
    std::vector<uint8_t> bytes = make_exr(f);
    const std::string name = "dataWindow";
    const auto at = std::search(bytes.begin(), bytes.end(), name.begin(), name.end());
    uint8_t* box = &*at + 21;  // past "dataWindow\0box2i\0" and the size
    const int right = claimed_width - 1, bottom = claimed_height - 1;
    std::memcpy(box + 8, &right, 4);
    std::memcpy(box + 12, &bottom, 4);
    try {
      decode_raster(bytes, "file");
    } catch (const InputError& e) {
      return e.reason();
    }
    return std::string();
  };
  ExrFixture f;
  CHECK(reason(f, 70, 50) == "");
  CHECK(reason(f, 100000, 100000).find("limit") != std::string::npos);
  CHECK(reason(f, 2000000000, 1).find("limit") != std::string::npos);
  // A few bytes may not claim gigabytes: the limit on the picture's memory rejects them.
  CHECK(reason(f, 1, 60000000).find("of memory") != std::string::npos);
  CHECK(reason(f, 0, 5) == "EXR with an empty data window");
  f.tile_width = f.tile_height = 64;
  CHECK(reason(f, 8000, 8000).find("of memory") != std::string::npos);
}

TEST_CASE("layers become named channels in their window") {
  const TemporaryFolder folder;
  const std::string path = folder.path("a.exr");
  const Image picture = random_image(8, 6, 1), albedo = random_image(8, 6, 2);
  Image depth(8, 6);
  for (size_t i = 0; i < depth.pixels.size(); ++i) depth.pixels[i].r = float(i);
  const std::vector<Layer> layers{{"", {"R", "G", "B"}, picture},
                                  {"albedo", {"R", "G", "B"}, albedo},
                                  {"normal", {"X", "Y", "Z"}, albedo},
                                  {"depth", {"Z"}, depth}};
  WriteOptions options;
  options.window = {10, 20, 100, 50};
  write_image(path, layers, options);
  CHECK(read_image(path).pixels == picture.pixels);

  const std::vector<uint8_t> bytes = read_file_bytes(path);
  const auto contains = [&](const std::string& s) {
    return std::search(bytes.begin(), bytes.end(), s.begin(), s.end()) != bytes.end();
  };
  for (const std::string name : {"albedo.B", "albedo.R", "normal.X", "normal.Z", "depth.Z"})
    CHECK(contains(name + std::string(1, '\0')));
  CHECK_FALSE(contains("depth.R"));
  const auto box = [](const std::string& name, const std::vector<int32_t>& corners) {
    std::string s = name + std::string("\0box2i\0\x10\0\0\0", 11);
    s.append(16, '\0');
    std::memcpy(s.data() + s.size() - 16, corners.data(), 16);
    return s;
  };
  CHECK(contains(box("dataWindow", {10, 20, 17, 25})));
  CHECK(contains(box("displayWindow", {0, 0, 99, 49})));

  write_image(path, std::span(layers).subspan(1, 1));  // a single layer is found
  CHECK(read_image(path).pixels == albedo.pixels);
  write_image(path, std::span(layers).subspan(3));
  CHECK(read_image(path).at(5, 2) == Rgb{21});
}

TEST_CASE("colours in an EXR file's own primaries become Rec. 709") {
  const std::vector<float> acescg{0.713f, 0.293f, 0.165f,   0.830f,
                                  0.128f, 0.044f, 0.32168f, 0.33767f};
  test::ExrFixture fixture{.width = 1, .height = 1, .constants = {3, 2, 1}};  // B, G, R
  fixture.chromaticities = acescg;
  const std::vector<uint8_t> bytes = test::make_exr(fixture);
  const Raster own = decode_raster(bytes, "a.exr");
  REQUIRE(own.primaries.has_value());
  CHECK(own.texels_float == std::vector<float>{1, 2, 3});
  // Published matrix for ACEScg with white adaptation.
  const Raster seen = rec709_raster(own, true);
  CHECK_FALSE(seen.primaries.has_value());
  const std::array<double, 3> wanted{1.70505 - 2 * 0.62179 - 3 * 0.08326,
                                     -0.13026 + 2 * 1.14080 - 3 * 0.01055,
                                     -0.02400 - 2 * 0.12897 + 3 * 1.15297};
  for (size_t c = 0; c < 3; ++c)
    CHECK(double(seen.texels_float[c]) == doctest::Approx(wanted[c]).epsilon(5e-4));
  // Without white adaptation, luminance follows from the primaries: white is D60.
  fixture.constants = {1, 1, 1};
  const Raster white = rec709_raster(decode_raster(test::make_exr(fixture), "a.exr"), false);
  const std::vector<float>& w = white.texels_float;
  CHECK(double(luminance(Rgb{w[0], w[1], w[2]})) == doctest::Approx(1).epsilon(1e-3));
  CHECK(w[0] > 1.02f);
  CHECK(w[2] < 0.95f);
  // Rec. 709 and degenerate primaries are ignored.
  fixture.chromaticities = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
  CHECK_FALSE(decode_raster(test::make_exr(fixture), "a.exr").primaries.has_value());
  fixture.chromaticities.assign(8, 0.5f);
  CHECK_FALSE(decode_raster(test::make_exr(fixture), "a.exr").primaries.has_value());
  fixture.chromaticities.assign(8, NAN);
  CHECK_FALSE(decode_raster(test::make_exr(fixture), "a.exr").primaries.has_value());
}
