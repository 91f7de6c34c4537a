#include "light/arctangent.h"

#include <doctest/doctest.h>

#include <cmath>

#include "base/random.h"

using namespace troffer;

TEST_CASE("upper_angle is atan2 for y >= 0") {
  Random random(1);
  double worst_float = 0, worst_double = 0;
  for (int i = 0; i < 200000; ++i) {
    const double y = std::pow(10.0, 12 * random.next_double() - 6);
    const double x =
        (random.next_double() < 0.5 ? -1 : 1) * std::pow(10.0, 6 * random.next_double() - 3);
    const auto yf = float(y), xf = float(x);
    worst_double = std::max(worst_double, std::abs(upper_angle(y, x) / std::atan2(y, x) - 1));
    worst_float =
        std::max(worst_float,
                 std::abs(double(upper_angle(yf, xf)) / std::atan2(double(yf), double(xf)) - 1));
  }
  CHECK(worst_double < 6e-16);
  CHECK(worst_float < 3e-7);
  CHECK(upper_angle(0.0, 1.0) == 0);
  CHECK(upper_angle(0.0, -1.0) == doctest::Approx(pi));
  CHECK(upper_angle(1.0, 0.0) == doctest::Approx(pi / 2));
  CHECK(upper_angle(0.0, 0.0) == 0);
}

TEST_CASE("sine and cosine of invalid angles are those of 0 or of a full turn") {
  for (const float any :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
        -std::numeric_limits<float>::infinity()}) {
    float s = 2, c = 2;
    sine_cosine(any, s, c);
    CHECK(std::abs(s) < 1e-6f);
    CHECK(std::abs(c - 1) < 1e-6f);
  }
}
