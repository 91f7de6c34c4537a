#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "transport/allowed_error.h"

using namespace troffer;

namespace {

// Variance of a picture with `samples` samples in all, relative to the variance allowed. Pixels of
// luminance b err by b n^(-q / 2), and samples are distributed so that all miss their allowed error
// by the same factor.
double variance_for(const std::vector<double>& luminances, double q, double samples,
                    const BrightPixelError& of_bright) {
  double wanted = 0, allowed2 = 0;
  for (const double b : luminances) {
    const double allowed = allowed_error(0.01, b, 1, of_bright);
    wanted += std::pow(b / allowed, 2 / q);
    allowed2 += allowed * allowed;
  }
  return allowed2 * std::pow(wanted / samples, q);
}

}  // namespace

TEST_CASE(
    "bright pixels may have more than the usual error, but less than in proportion to their "
    "light") {
  CHECK(allowed_error(0.1, 0.01, 2) == doctest::Approx(0.2));
  CHECK(allowed_error(0.1, 8, 2) == doctest::Approx(0.1 * 4));
  CHECK(allowed_error(0.1, 8, 2, {16, 0.6}) ==
        doctest::Approx(0.1 * std::pow(8, 0.4) * std::pow(2, 0.6)));
  // the factor that limits the reduction
  CHECK(allowed_error(0.1, 1e6, 1) == doctest::Approx(1e5 / 4));
  CHECK(allowed_error(0.1, 1e9, 1, {16, 0.6}) == doctest::Approx(1e8 / 16));
  CHECK(allowed_error(0.1, 3, 0) == doctest::Approx(0.3 / 4));
}

TEST_CASE("the allowed error of bright pixels minimizes the picture's error for its samples") {
  std::vector<double> luminances;
  for (int k = 0; k < 50; ++k) luminances.push_back(std::pow(1.1, k));
  struct Law {
    double q, of_usual;
  };
  for (const Law& law : {Law{1, 0.5}, Law{1.5, 0.6}}) {
    CAPTURE(law.q);
    const double best = variance_for(luminances, law.q, 1e6, {1e9, law.of_usual});
    for (const double other : {-0.1, -0.03, 0.03, 0.1})
      CHECK(best < variance_for(luminances, law.q, 1e6, {1e9, law.of_usual + other}));
  }
}
