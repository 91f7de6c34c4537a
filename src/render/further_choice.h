// Chooses how the further viewing rays of a tile are computed: like the first ones, by the
// picture's integrator at one of several effort divisors, or by its cheaper integrator
// (Integrator::cheaper). All have the same mean. A few test rays of each measure the variance of a
// ray and its cost; the choice has the least product of both, which is the cost of a given error.
// Test rays enter no result, so the choice leaves the mean of every pixel unbiased.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace troffer {

// A way of computing further viewing rays.
struct FurtherWay {
  uint32_t effort_divisor = 1;  // SampleRequest::effort_divisor
  bool is_cheaper = false;      // by Integrator::cheaper
  bool is_like_first = false;   // as carefully as the first rays of a pixel
};
constexpr std::array<FurtherWay, 5> further_ways{
    {{1, false, true}, {1}, {4}, {16}, {.is_cheaper = true}}};

// Test rays of one tile.
constexpr size_t test_pixels = 4;
constexpr uint32_t test_rays_of_pixel = 8;

struct FurtherChoice {
  FurtherWay way;
  bool is_tested = false;
  double rays = 0;   // if tested: further rays of a pixel of the tile
  double times = 1;  // if tested: `rays` over the number that was planned
};

// Luminances of the test rays of one way, pixel by pixel, and their cost (costs.h).
struct TestedWay {
  FurtherWay way;
  std::vector<double> luminances;
  double cost = 0;
};

// A test pixel, as the first pass left it.
struct TestPixel {
  double luminance = 0;  // excludes known radiance if those of the test rays do
  double allowed = 1;    // error of the pixel
  double planned = 0;    // further rays
  double rays = 4;       // first rays
};

// Returns the way of least cost for a given error. The first of `tested` is like the first rays of
// a pixel; its variance is the mean of what the plan and the test say. Another way is rejected if
// its test rays find less than half the light that the first rays found: the missing light may come
// in rays so rare and bright that no test meets one, such as samples of a lamp behind a pinhole. No
// other way is assumed to have less variance than the first. most_even: as in samples_for()
// (sample_spread.h).
FurtherChoice choose_further_way(std::span<const TestPixel> pixels,
                                 std::span<const TestedWay> tested, double most_even);

}  // namespace troffer
