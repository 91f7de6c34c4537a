// Choice between ways of computing further viewing rays (render/further_choice.h), on samples whose
// variances and costs are known.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <vector>

#include "render/further_choice.h"

using namespace troffer;

namespace {

constexpr size_t rays = test_pixels * test_rays_of_pixel;

// Test rays of a mean and of exactly this variance (with n - 1 in the denominator) in each pixel.
TestedWay way(size_t number, double mean, double variance, double cost) {
  TestedWay w{further_ways.at(number), {}, cost};
  const double step = std::sqrt(variance * (test_rays_of_pixel - 1) / test_rays_of_pixel);
  for (size_t i = 0; i < rays; ++i) w.luminances.push_back(mean + (i % 2 == 0 ? step : -step));
  return w;
}

// Pixels of luminance 1 that may err by .1.
std::vector<TestPixel> pixels(double planned) {
  return std::vector<TestPixel>(test_pixels, {.luminance = 1, .allowed = 0.1, .planned = planned});
}

}  // namespace

TEST_CASE("the way of the least variance times cost is chosen") {
  // Products 8, 6 and 7. Eight rays are planned for the variance .08.
  const std::vector<TestedWay> tested{way(0, 1, 0.08, 100), way(1, 1, 0.2, 30), way(3, 1, 0.7, 10)};
  const FurtherChoice choice = choose_further_way(pixels(8), tested, 0);
  CHECK(choice.is_tested);
  CHECK(choice.way.effort_divisor == further_ways[1].effort_divisor);
  CHECK_FALSE(choice.way.is_like_first);
  // n = V / allowed² = .2 / .01
  CHECK(choice.rays == doctest::Approx(20));
  CHECK(choice.times == doctest::Approx(2.5));
}

TEST_CASE("many rays follow the standard deviation") {
  const std::vector<TestedWay> tested{way(0, 1, 4, 1)};
  const double rays = 6 * std::sqrt(400);
  CHECK(choose_further_way(pixels(rays), tested, 6).rays == doctest::Approx(rays));
}

TEST_CASE("ways that miss light are out, however little their rays vary and cost") {
  // A lamp behind a pinhole: proofs see it, no draw of a few finds it.
  const std::vector<TestedWay> blind{way(0, 1, 1, 1000), way(2, 0, 0, 1), way(3, 0.4, 1e-6, 1)};
  CHECK(choose_further_way(pixels(10), blind, 0).way.is_like_first);
  const std::vector<TestedWay> seeing{way(0, 1, 1, 1000), way(2, 0, 0, 1), way(3, 0.9, 1, 1)};
  CHECK_FALSE(choose_further_way(pixels(10), seeing, 0).way.is_like_first);
}

TEST_CASE("a test that happens to see little variance does not reduce the rays") {
  // 100 rays are planned; the test of a cheaper way saw none of the variance.
  const std::vector<TestedWay> tested{way(0, 1, 1, 10), way(4, 1, 0, 1)};
  const FurtherChoice choice = choose_further_way(pixels(100), tested, 0);
  CHECK(choice.way.is_cheaper);
  CHECK(choice.rays == doctest::Approx(100));
}
