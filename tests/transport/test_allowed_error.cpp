#include <doctest/doctest.h>

#include <vector>

#include "transport/allowed_error.h"

using namespace troffer;

TEST_CASE(
    "bright pixels are judged relative to their own luminance, dark ones by the typical one") {
  CHECK(allowed_error(0.1, 0.01, 2) == doctest::Approx(0.2));
  CHECK(allowed_error(0.1, 2, 2) == doctest::Approx(0.2));
  CHECK(allowed_error(0.1, 6, 2) == doctest::Approx(0.6));
  CHECK(allowed_error(0.1, 80, 2) == doctest::Approx(0.8));
  CHECK(allowed_error(0.1, 3, 0) == doctest::Approx(0.3));
}

TEST_CASE("the usual luminance leaves out the brightest twentieth") {
  std::vector<double> values(95, 1.0);
  values.resize(100, 1000.0);
  CHECK(usual_luminance(values) == doctest::Approx(1));
}
