// Automatic exposure of pictures.
#include "image/exposure.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace troffer;

TEST_CASE("the exposure that brings a picture to mid-grey") {
  CHECK(brightness(Image(4, 4)).is_black);
  CHECK(brightness(Image(4, 4)).auto_stops == 0);
  const Brightness even = brightness(Image(8, 8, Rgb{18}));
  CHECK_FALSE(even.is_black);
  CHECK(even.auto_stops == doctest::Approx(std::log2(0.01)));
  // A few source pixels and black pixels change nothing.
  Image image(100, 10, Rgb{0.18f});
  for (size_t i = 0; i < 30; ++i) image.pixels[i] = Rgb{1e6f};
  for (size_t i = 30; i < 400; ++i) image.pixels[i] = Rgb{0};
  image.pixels[500] = Rgb{NAN};
  CHECK(std::abs(brightness(image).auto_stops) < 0.3);
}
