#include <doctest/doctest.h>

#include <cmath>

#include "base/random.h"
#include "cells/linear_fit.h"

using namespace troffer;

TEST_CASE("a linear fit reproduces a slope exactly, also at its border") {
  for (const float from : {-1.0f, 0.0f}) {
    LinearFit fit;
    for (float u = from; u <= 1; u += 0.25f)
      for (float v = -1; v <= 1; v += 0.25f)
        if (u * u + v * v < 1)
          fit.add(u, v, 1 - u * u - v * v, 1 + u * u, Rgb{5 + 2 * u - v, 4 + v, 3 - u});
    FittedLight light;
    REQUIRE(fit.solve(light));
    CHECK(double(light.value.r) == doctest::Approx(5).epsilon(0.005));
    CHECK(double(light.value.g) == doctest::Approx(4).epsilon(0.005));
    CHECK(double(light.value.b) == doctest::Approx(3).epsilon(0.005));
    CHECK(light.spread < 1e-3);
  }
}

TEST_CASE("a linear fit estimates its own variance") {
  Random random(3);
  const auto noise = [&] { return std::sqrt(12.0f) * (random.next_float() - 0.5f); };
  for (const float from : {-1.0f, 0.0f}) {
    double told = 0, made = 0, spread = 0;
    constexpr int sets = 4000;
    for (int s = 0; s < sets; ++s) {
      LinearFit fit;
      for (float u = from; u <= 1; u += 0.25f)
        for (float v = -1; v <= 1; v += 0.25f) {
          const float rays = u > 0.3f ? 4.0f : 1.0f;
          if (u * u + v * v < 1)
            fit.add(u, v, 1 - u * u - v * v, rays,
                    Rgb{100 + 10 * u + 5 * v + noise() / std::sqrt(rays)});
        }
      FittedLight light;
      REQUIRE(fit.solve(light));
      told += light.spread / light.neighbours / sets;
      spread += light.spread / sets;
      made += (double(light.value.g) - 100) * (double(light.value.g) - 100) / sets;
    }
    CHECK(spread == doctest::Approx(1).epsilon(0.05));
    CHECK(told == doctest::Approx(made).epsilon(0.1));
  }
}

TEST_CASE("with few neighbours the fit is their mean") {
  LinearFit fit;
  FittedLight light;
  CHECK(!fit.solve(light));
  fit.add(0, 0, 1, 1, Rgb{1});
  fit.add(0.1f, 0, 1, 3, Rgb{5});
  CHECK(!fit.solve(light));
  CHECK(double(light.value.r) == doctest::Approx(4));
  CHECK(light.neighbours == doctest::Approx(4));
}
