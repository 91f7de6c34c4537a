// Colour information of files: gamma and profiles compared with the formulas.
#include <doctest/doctest.h>

#include <cmath>

#include "base/rgb.h"
#include "image/fixtures.h"
#include "image/raster.h"

using namespace troffer;
using test::make_grey_profile;
using test::make_jpeg;
using test::make_png;
using test::make_rgb_profile;
using test::PngFixture;

namespace {

// X, Y, Z (D50) of red, green and blue.
const std::array<Vec3d, 3> srgb_colorants{Vec3d{0.43607, 0.22249, 0.01392},
                                          Vec3d{0.38515, 0.71687, 0.09708},
                                          Vec3d{0.14307, 0.06061, 0.71410}};
const std::array<Vec3d, 3> adobe_colorants{Vec3d{0.60974, 0.31111, 0.01947},
                                           Vec3d{0.20528, 0.62567, 0.06087},
                                           Vec3d{0.14919, 0.06322, 0.74457}};

// Returns a PNG with a row of pixels of 8 or 16 bits.
PngFixture row_of(int colour_type, int channels, int depth, const std::vector<int>& values) {
  PngFixture f{.width = int(values.size()) / channels,
               .height = 1,
               .colour_type = colour_type,
               .depth = depth,
               .rows = {},
               .palette_rgb = {},
               .palette_alpha = {}};
  std::vector<uint8_t> row;
  for (const int v : values) {
    if (depth == 16) row.push_back(uint8_t(v >> 8));
    row.push_back(uint8_t(v & 0xff));
  }
  f.rows.push_back(row);
  return f;
}

struct Obeyed {
  ColoursFound found;
  Raster raster;
};
Obeyed obey(const std::vector<uint8_t>& bytes) {
  Raster raster = decode_raster(bytes, "file");
  const ColoursFound found = convert_to_srgb(raster);
  return {found, std::move(raster)};
}

Rgb light_at(const Raster& raster, size_t pixel) {
  const Raster linear = linear_raster(raster);
  const float* at = linear.texels_float.data() + pixel * size_t(linear.channels);
  return linear.channels < 3 ? Rgb{at[0]} : Rgb{at[0], at[1], at[2]};
}

double determinant(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return dot(a, cross(b, c));
}

// Converts encoded values of a profile with this power and colorants to linear sRGB.
Vec3d in_srgb(const Vec3d& encoded, const std::array<Vec3d, 3>& colorants, double power) {
  Vec3d xyz{0, 0, 0};
  for (size_t k = 0; k < 3; ++k) xyz = xyz + colorants[k] * std::pow(encoded[k], power);
  const auto& [r, g, b] = srgb_colorants;
  const double all = determinant(r, g, b);
  return {determinant(xyz, g, b) / all, determinant(r, xyz, b) / all, determinant(r, g, xyz) / all};
}

}  // namespace

TEST_CASE("PNG gamma: linear values stay, others are converted to sRGB, alpha is unchanged") {
  const std::vector<int> values{0, 1, 40, 7, 128, 200, 255, 99};
  for (const int depth : {8, 16})
    for (const double gamma : {1.0, 1 / 1.8, 0.25}) {
      CAPTURE(depth);
      CAPTURE(gamma);
      std::vector<int> wide = values;
      if (depth == 16)
        for (int& v : wide) v *= 257;
      PngFixture f = row_of(6, 4, depth, wide);
      f.gamma = gamma;
      const Obeyed o = obey(make_png(f));
      CHECK(o.found == ColoursFound::obeyed);
      CHECK(o.raster.is_srgb == (gamma != 1));
      const Raster linear = linear_raster(o.raster);
      for (size_t i = 0; i < values.size(); ++i) {
        const double v = values[i] / 255.0;
        const double expected = i % 4 == 3 ? v : std::pow(v, 1 / gamma);
        // 8-bit sRGB: half a step at the steepest part of the curve.
        const double rounding = depth == 8 && gamma != 1 && i % 4 != 3 ? 0.5 / 255 * 2.3 : 1e-5;
        CHECK(std::abs(double(linear.texels_float[i]) - expected) <= rounding);
      }
    }
}

TEST_CASE("files marked sRGB, unmarked or with invalid marks stay unchanged") {
  PngFixture f = row_of(2, 3, 8, {10, 100, 250});
  const auto stays = [&](ColoursFound expected) {
    const Obeyed o = obey(make_png(f));
    CHECK(o.found == expected);
    CHECK(o.raster.is_srgb);
    CHECK(o.raster.own.is_empty());
    CHECK(o.raster.texels8 == std::vector<uint8_t>{10, 100, 250});
  };
  stays(ColoursFound::none);
  f.gamma = 0.45455;
  stays(ColoursFound::none);
  f.is_marked_srgb = true;
  stays(ColoursFound::none);
  f.is_marked_srgb = false;
  f.gamma = 0.001;
  stays(ColoursFound::broken);
}

TEST_CASE("profiles by matrix and power, in PNG of 8 and 16 bits and in JPEG") {
  const std::vector<uint8_t> profile = make_rgb_profile(adobe_colorants, 2.19921875);
  const Vec3d encoded{0.6, 0.5, 0.4};
  const Vec3d expected = in_srgb(encoded, adobe_colorants, 2.19921875);
  const auto check = [&](const std::vector<uint8_t>& bytes, double tolerance) {
    const Obeyed o = obey(bytes);
    CHECK(o.found == ColoursFound::obeyed);
    const Rgb light = light_at(o.raster, 0);
    for (size_t k = 0; k < 3; ++k) CHECK(std::abs(double(light[k]) - expected[k]) < tolerance);
  };
  PngFixture f = row_of(2, 3, 16, {int(0.6 * 65535), int(0.5 * 65535), int(0.4 * 65535)});
  f.profile = profile;
  check(make_png(f), 1e-3);
  f = row_of(2, 3, 8, {153, 128, 102});  // of 255
  f.profile = profile;
  check(make_png(f), 0.01);
  std::vector<uint8_t> block;
  for (int i = 0; i < 64; ++i) block.insert(block.end(), {153, 128, 102});
  check(make_jpeg(8, 8, 3, block, false, profile), 0.015);
  // Interpreted as sRGB, red would differ.
  CHECK(std::abs(expected[0] - double(linear_from_srgb(0.6f))) > 0.03);
}

TEST_CASE("linear and grey profiles; alpha stays") {
  PngFixture f = row_of(6, 4, 8, {64, 64, 64, 17});
  f.profile = make_rgb_profile(srgb_colorants, 1);
  Obeyed o = obey(make_png(f));
  CHECK(o.found == ColoursFound::obeyed);
  for (size_t k = 0; k < 3; ++k)
    CHECK(light_at(o.raster, 0)[k] == doctest::Approx(64.0 / 255).epsilon(0.01));
  CHECK(o.raster.texels8.at(3) == 17);

  for (const int depth : {8, 16}) {
    const int most = depth == 8 ? 255 : 65535;
    f = row_of(4, 2, depth, {most / 2, most / 3});
    f.profile = make_grey_profile(1.5);
    o = obey(make_png(f));
    CHECK(o.found == ColoursFound::obeyed);
    CHECK(light_at(o.raster, 0).r == doctest::Approx(std::pow(0.5, 1.5)).epsilon(0.01));
    const Raster linear = linear_raster(o.raster);
    CHECK(linear.texels_float.at(1) == doctest::Approx(1.0 / 3).epsilon(0.005));
  }
}

TEST_CASE("invalid profiles are ignored: broken ones, and those for other channels") {
  const std::vector<uint8_t> good = make_rgb_profile(adobe_colorants, 2.2);
  std::vector<uint8_t> block(64 * 3, 100);
  for (const size_t length : {size_t(20), size_t(130), good.size() - 40}) {
    CAPTURE(length);
    std::vector<uint8_t> bad(good.begin(), good.begin() + std::ptrdiff_t(length));
    const Obeyed o = obey(make_jpeg(8, 8, 3, block, false, bad));
    CHECK(o.found == ColoursFound::broken);
    CHECK(o.raster.is_srgb);
  }
  CHECK(obey(make_jpeg(8, 8, 3, block, false, make_grey_profile(1))).found == ColoursFound::broken);
  CHECK(obey(make_jpeg(8, 8, 1, block, false, good)).found == ColoursFound::broken);
  // Corrupts every byte in turn.
  const std::vector<uint8_t> jpeg_of_good = make_jpeg(8, 8, 3, block, false, good);
  for (size_t i = 0; i < good.size(); ++i)
    for (const uint8_t v : {0x00, 0x7f, 0xff}) {
      std::vector<uint8_t> bad = good;
      bad[i] = v;
      Raster raster = decode_raster(jpeg_of_good, "file");
      raster.own.profile = bad;
      convert_to_srgb(raster);
      CHECK(raster.texels8.size() == 8 * 8 * 3);
    }
}
