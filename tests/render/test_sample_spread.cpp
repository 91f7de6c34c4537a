// Number of samples of a pixel and sampling effort for each (render/sample_spread.h).
#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>

#include "render/sample_spread.h"

using namespace troffer;

namespace {

constexpr double allowed = 0.02, allowed2 = allowed * allowed;

SampleNeed need(const SampleSpread& spread, uint32_t most_effort_divisor, double most_even = 0,
                double most = 1e9) {
  return least_work(spread, 1, allowed, {4, most, most_even, 0, most_effort_divisor});
}

}  // namespace

TEST_CASE("the spread of samples decides how many are needed") {
  CHECK(need({}, 1).count == 0);
  CHECK(need({.chance = 0.04}, 1).count == doctest::Approx(0.04 / allowed2));
  CHECK(need({.placed = 0.04}, 1).count == doctest::Approx(std::pow(0.04 / allowed2, 2.0 / 3)));
  CHECK(need({.thin = 0.04}, 1).count == doctest::Approx(0.04 / allowed2));
  CHECK(need({.clutter = 0.04}, 1).count == doctest::Approx(0.04 / allowed2));
  CHECK(need({.chance = 0.04}, 1, 6).count == doctest::Approx(6 * std::sqrt(0.04 / allowed2)));
  for (const uint32_t most : {1u, 16u}) {
    // No more than the pixel has.
    CHECK(need({.chance = 3.9 * allowed2}, most).count <= 4);
    CHECK(need({.placed = 7.9 * allowed2}, most).count <= 4);
  }
}

TEST_CASE("the more a pixel's rays differ by what they hit, the lower the effort for each") {
  // Lower effort does not help against independent variance alone.
  CHECK(need({.chance = 0.5}, 16).effort_divisor == 1);
  uint32_t last = 1;
  for (const double edge : {0.1, 1.0, 10.0, 100.0}) {
    const SampleNeed n = need({.chance = 0.01, .placed = edge}, 16);
    CAPTURE(edge);
    CHECK(n.effort_divisor >= last);
    CHECK(n.count >= std::pow(edge / allowed2, 2.0 / 3));
    last = n.effort_divisor;
  }
  CHECK(last == 16);
}

// If the number of rays is limited, each gets the full effort.
TEST_CASE("a pixel whose ray limit is too low for reduced effort keeps the full effort") {
  const SampleSpread edge{.chance = 0.01, .placed = 100};
  const SampleNeed all = need(edge, 16);
  REQUIRE(all.effort_divisor == 16);
  const SampleNeed some = need(edge, 16, 0, 0.9 * all.count);
  CHECK(some.effort_divisor < all.effort_divisor);
  CHECK(some.count <= 0.9 * all.count);
  CHECK(need(edge, 16, 0, 16).effort_divisor == 1);
}

TEST_CASE("reduced effort never costs more than full effort") {
  const auto work = [](const SampleNeed& n) { return n.count * (0.1 + 1.0 / n.effort_divisor); };
  for (const double chance : {1e-4, 1e-2, 1.0})
    for (const double placed : {0.0, 1e-2, 1.0})
      for (const double thin : {0.0, 1e-2, 1.0})
        for (const double clutter : {0.0, 1e-3, 1.0})
          for (const double even : {0.0, 6.0}) {
            const SampleSpread s{chance, placed, thin, clutter};
            double least = 1e300;
            for (const uint32_t most : {2u, 4u, 8u, 16u}) {
              const SampleNeed n = need(s, most, even);
              CHECK(n.effort_divisor <= most);
              CHECK(work(n) <= least * (1 + 1e-9));
              least = work(n);
            }
          }
}
