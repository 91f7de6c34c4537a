#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "image/tone_map.h"

using namespace troffer;

TEST_CASE("the filmic curve rises, keeps mid-grey and reaches white") {
  CHECK(filmic(0) == 0);
  CHECK(filmic(-1) == 0);
  CHECK(filmic(std::nanf("")) == 0);
  CHECK(filmic(0.18f) == doctest::Approx(0.18).epsilon(1e-6));
  CHECK(filmic(std::numeric_limits<float>::infinity()) == 1);
  CHECK(filmic(1e30f) == 1);
  float last = 0;
  for (float x = 0.001f; x < 3.82f; x *= 1.01f) {
    const float y = filmic(x);
    CHECK(y > last);
    CHECK(y < 1);
    last = y;
  }
  CHECK(filmic(3.826f) == 1);
  CHECK(filmic(3.825f) == doctest::Approx(1).epsilon(1e-4));
}

TEST_CASE("srgb8: exposure in stops, clamp, rounding") {
  Image image(5, 1);
  image.at(0, 0) = Rgb{0.5f, 1, 2};
  image.at(1, 0) = Rgb{std::nanf(""), -1, std::numeric_limits<float>::infinity()};
  image.at(2, 0) = Rgb{0.21404f};  // sRGB 0.5 = 127.5
  image.at(3, 0) = Rgb{linear_from_srgb(100.49f / 255)};
  image.at(4, 0) = Rgb{linear_from_srgb(100.51f / 255)};
  const auto plain = srgb8(image);
  CHECK(plain[0] == 188);
  CHECK(plain[1] == 255);
  CHECK(plain[2] == 255);
  CHECK(plain[3] == 0);
  CHECK(plain[4] == 0);
  CHECK(plain[5] == 255);
  CHECK(plain[9] == 100);
  CHECK(plain[12] == 101);
  const auto brighter = srgb8(image, {1, ToneMap::none});
  CHECK(brighter[0] == 255);
  const auto darker = srgb8(image, {-1, ToneMap::none});
  CHECK(darker[2] == 255);
  CHECK(darker[1] == plain[0]);
  const auto filmic8 = srgb8(image, {0, ToneMap::filmic});
  CHECK(filmic8[2] < 255);
  CHECK(filmic8[2] > filmic8[1]);
}
