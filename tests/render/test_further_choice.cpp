// Choice between ways of computing further viewing rays (render/further_choice.h), on samples whose
// variances and costs are known.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <vector>

#include "render/further_choice.h"

using namespace troffer;

namespace {

// Test rays of a mean and of exactly this variance (with n - 1 in the denominator) in each pixel.
TestedWay way(const FurtherWay& w, double mean, double variance, double cost) {
  TestedWay tested{w, cost, {}};
  const double step = std::sqrt(variance * (test_rays_of_pixel - 1) / test_rays_of_pixel);
  for (std::vector<double>& pixel : tested.luminances)
    for (size_t i = 0; i < test_rays_of_pixel; ++i)
      pixel.push_back(mean + (i % 2 == 0 ? step : -step));
  return tested;
}
constexpr FurtherWay cheaper{.is_cheaper = true};

// Pixels of luminance 1 that may err by .1.
std::vector<TestPixel> pixels(double planned) {
  return std::vector<TestPixel>(test_pixels, {.luminance = 1, .allowed = 0.1, .planned = planned});
}

}  // namespace

TEST_CASE("the way of the least variance times cost is chosen") {
  // Products 8, 6 and 7. Eight rays are planned for the variance .08.
  const std::vector<TestedWay> tested{way({1}, 1, 0.2, 30), way({16}, 1, 0.7, 10)};
  const FurtherChoice choice = choose_further_way(pixels(8), 100, tested, 0);
  CHECK(choice.way.effort_divisor == 1);
  CHECK_FALSE(choice.way.is_like_first);
  // n = V / allowed² = .2 / .01
  CHECK(choice.rays == doctest::Approx(20));
  CHECK(choice.times == doctest::Approx(2.5));
  CHECK(choice.cost == doctest::Approx(600));
  // Rays like the first ones would take 800; if they cost less, they are chosen.
  CHECK(choose_further_way(pixels(8), 70, tested, 0).way.is_like_first);
}

TEST_CASE("many rays follow the standard deviation") {
  const double rays = 6 * std::sqrt(400);
  CHECK(choose_further_way(pixels(rays), 1, {}, 6).rays == doctest::Approx(rays));
  const std::vector<TestedWay> tested{way({4}, 1, 4, 0.5)};
  CHECK(choose_further_way(pixels(rays), 1, tested, 6).rays == doctest::Approx(rays));
}

TEST_CASE("ways that miss light are out, however little their rays vary and cost") {
  // A lamp behind a pinhole: proofs see it, no draw of a few finds it.
  const std::vector<TestedWay> blind{way({16}, 0, 0, 1), way(cheaper, 0.4, 1e-6, 1)};
  CHECK(choose_further_way(pixels(10), 1000, blind, 0).way.is_like_first);
  const std::vector<TestedWay> seeing{way({16}, 0, 0, 1), way(cheaper, 0.9, 1, 1)};
  CHECK(choose_further_way(pixels(10), 1000, seeing, 0).way.is_cheaper);
}

TEST_CASE("a test that happens to see little variance does not reduce the rays") {
  // 100 rays are planned; the test of a cheaper way saw none of the variance.
  const std::vector<TestedWay> tested{way(cheaper, 1, 0, 1)};
  const FurtherChoice choice = choose_further_way(pixels(100), 10, tested, 0);
  CHECK(choice.way.is_cheaper);
  CHECK(choice.rays == doctest::Approx(100));
}
