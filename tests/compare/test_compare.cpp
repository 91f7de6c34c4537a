#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/random.h"
#include "compare/compare.h"
#include "compare/maps.h"
#include "image/read_image.h"
#include "image/tone_map.h"

using namespace troffer;

TEST_CASE("the numbers of a comparison agree with a calculation by hand") {
  Image image(2, 1), reference(2, 1);
  image.at(0, 0) = {1, 0, 0};
  image.at(1, 0) = {0.5f, 0.5f, 4};
  reference.at(0, 0) = {0, 0, 0};
  reference.at(1, 0) = {0.5f, 1, 2};
  const Comparison c = compare_images(image, reference, "a");
  CHECK(c.mean_image == doctest::Approx(6.0 / 6));
  CHECK(c.mean_reference == doctest::Approx(3.5 / 6));
  CHECK(c.rmse == doctest::Approx(std::sqrt((1 + 0.25 + 4) / 6)));
  CHECK(c.relative_rmse == doctest::Approx(c.rmse / c.mean_reference));
  // 255 steps in one channel, 255 - 188 in another; 4 and 2 are both clamped to 255.
  CHECK(c.average_difference == doctest::Approx((255.0 + 67) / 6));
  CHECK(c.flip > 0);
  CHECK(c.compared_pixels == 2);
  CHECK(c.non_finite_pixels == 0);
}

TEST_CASE("equal images have no differences") {
  Image image(20, 10);
  Random random(1);
  for (Rgb& p : image.pixels) p = {random.next_float(), random.next_float(), random.next_float()};
  const Comparison c = compare_images(image, image, "a");
  CHECK(c.rmse == 0);
  CHECK(c.relative_rmse == 0);
  CHECK(c.average_difference == 0);
  CHECK(c.flip == 0);
  CHECK(c.mean_image == c.mean_reference);
}

TEST_CASE("pixels that are not finite in both are counted and left out") {
  Image image(10, 10, Rgb{0.5f}), reference(10, 10, Rgb{0.5f});
  image.at(3, 3).g = std::nanf("");
  image.at(4, 4).b = std::numeric_limits<float>::infinity();
  reference.at(4, 4).r = std::nanf("");
  reference.at(5, 5) = Rgb{-std::numeric_limits<float>::infinity()};
  const Comparison c = compare_images(image, reference, "a");
  CHECK(c.non_finite_pixels == 3);
  CHECK(c.compared_pixels == 97);
  CHECK(c.rmse == 0);
  CHECK(c.mean_image == doctest::Approx(0.5));
  CHECK(std::isfinite(c.flip));
  CHECK_THROWS_AS(compare_images(Image(2, 2, Rgb{std::nanf("")}), Image(2, 2), "a"), InputError);
}

TEST_CASE("images of different size are an error that names both sizes") {
  try {
    compare_images(Image(4, 3), Image(3, 4), "a.exr");
    FAIL("no error");
  } catch (const InputError& e) {
    CHECK(e.file() == "a.exr");
    CHECK(e.reason() == "size is 4x3, the reference's is 3x4");
  }
}

TEST_CASE("a black reference") {
  const Comparison c = compare_images(Image(2, 2, Rgb{1}), Image(2, 2), "a");
  CHECK(std::isinf(c.relative_rmse));
  CHECK(compare_images(Image(2, 2), Image(2, 2), "a").relative_rmse == 0);
}

TEST_CASE("the number of threads does not change a bit") {
  Random random(2);
  Image a(70, 50), b(70, 50);
  for (Image* image : {&a, &b})
    for (Rgb& p : image->pixels) p = {random.next_float(), random.next_float(), 1};
  const Comparison one = compare_images(a, b, "a", 1), three = compare_images(a, b, "a", 3);
  CHECK(one.rmse == three.rmse);
  CHECK(one.flip == three.flip);
  CHECK(one.mean_image == three.mean_image);
  CHECK(one.average_difference == three.average_difference);
}

TEST_CASE("the reference pictures agree with each other") {
  const std::string folder = std::string(TROFFER_SOURCE_DIR) + "/scenes/references/";
  const Image direct = read_image(folder + "kj92room_direct.exr");
  const Image full = read_image(folder + "kj92room_full.exr");
  const Comparison c = compare_images(direct, full, "direct");
  CHECK(c.mean_image == doctest::Approx(0.1761).epsilon(3e-4));
  CHECK(c.mean_reference == doctest::Approx(0.3704).epsilon(3e-4));
  CHECK(c.flip > 0.1);
  CHECK(c.flip < 0.6);
}

TEST_CASE("the magma colour map gets lighter from black to pale yellow") {
  const auto bytes = [](float v) { return srgb8(Image(1, 1, magma(v))); };
  CHECK(bytes(0) == std::vector<uint8_t>{0, 0, 4});
  CHECK(bytes(0.5f) == std::vector<uint8_t>{181, 54, 122});
  CHECK(bytes(1) == std::vector<uint8_t>{252, 253, 191});
  CHECK(bytes(2) == bytes(1));
  CHECK(bytes(-1) == bytes(0));
  CHECK(bytes(std::nanf("")) == bytes(0));
  for (float v = 0; v < 1; v += 0.01f) CHECK(luminance(magma(v + 0.01f)) > luminance(magma(v)));
}

TEST_CASE("difference maps") {
  const Image a(3, 2, Rgb{0.5f, 0.5f, 0.5f}), b(3, 2, Rgb{0.25f, 0.75f, 0.5f});
  CHECK(absolute_difference_map(a, b).at(2, 1) == Rgb{0.25f, 0.25f, 0});
  CHECK(absolute_difference_map(a, b, 4).at(0, 0) == Rgb{1, 1, 0});
  const Rgb darker = signed_difference_map(a, b).at(0, 0),
            brighter = signed_difference_map(b, a).at(0, 0);
  CHECK(darker.b > 0);
  CHECK(darker.r == 0);
  CHECK(brighter.r == darker.b);
  CHECK(signed_difference_map(a, a).at(0, 0) == Rgb{0});
  const Image map = flip_map(a, b);
  CHECK(map.width == 3);
  CHECK(map.height == 2);
  CHECK(flip_map(a, a).at(1, 1) == magma(0));
}
