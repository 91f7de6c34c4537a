#include <doctest/doctest.h>

#include <cmath>

#include "render/sample_spread.h"

using namespace troffer;

TEST_CASE("samples follow the law by which each kind of variance falls") {
  constexpr double allowed = 0.01, variance = 0.04;  // a standard deviation of 20 times the error
  CHECK(samples_for({}, allowed, 0, 0) == 0);
  CHECK(samples_for({.chance = variance}, allowed, 0, 0) == doctest::Approx(400));
  CHECK(samples_for({.thin = variance}, allowed, 0, 0) == doctest::Approx(400));
  CHECK(samples_for({.clutter = variance}, allowed, 0, 0) == doctest::Approx(400));
  // n^-3/4 = 1 / 20
  CHECK(samples_for({.placed = variance}, allowed, 0, 0) == doctest::Approx(std::pow(20, 4.0 / 3)));
  // n^-(1 + e)/2 = 1 / 20
  CHECK(samples_for({.chance = variance}, allowed, 0, 0.5) ==
        doctest::Approx(std::pow(400, 1 / 1.5)));
}

TEST_CASE("large numbers of samples are in proportion to the standard deviation") {
  constexpr double allowed = 0.01, even = 6;
  const double at_limit = samples_for({.chance = 36e-4}, allowed, even, 0);
  CHECK(at_limit == doctest::Approx(36));
  CHECK(samples_for({.chance = 4 * 36e-4}, allowed, even, 0) == doctest::Approx(2 * at_limit));
  CHECK(samples_for({.chance = 36e-4 / 4}, allowed, even, 0) == doctest::Approx(at_limit / 4));
}
