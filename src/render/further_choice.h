// Chooses how the further viewing rays of a tile are computed: like the first ones, by the
// picture's integrator at one of several effort divisors, or by its cheaper integrator
// (Integrator::cheaper). All have the same mean. A few test rays of each measure the variance of a
// ray and its cost; the choice has the least product of both, which is the cost of a given error.
// The first pass has measured first rays; where they cost much, they are tested, too, because the
// few of a pixel do not show rare light. Test rays enter no result, so the choice leaves the mean
// of every pixel unbiased.
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
// All ways. They are tested from the last to the first: cheap tests first.
constexpr std::array<FurtherWay, 4> further_ways{
    {{1, false, true}, {4}, {16}, {.is_cheaper = true}}};

// Pixels of a tile whose further rays are tested, and the first test rays of each.
constexpr size_t test_pixels = 4;
constexpr uint32_t test_rays_of_pixel = 8;

struct FurtherChoice {
  FurtherWay way;
  double rays = 0;   // further rays of a pixel of the tile
  double times = 1;  // factor on the further rays planned for the test pixels
  double cost = 0;   // of the further rays of a pixel (costs.h)
};

// Luminances of the test rays of one way, for each test pixel, and the cost of a ray (costs.h).
struct TestedWay {
  FurtherWay way;
  double cost_of_ray = 0;
  std::array<std::vector<double>, test_pixels> luminances;
};

// A test pixel, as the first pass left it.
struct TestPixel {
  double luminance = 0;  // without known radiance if the test rays are without it
  double allowed = 1;    // error of the pixel
  double planned = 0;    // further rays
  double rays = 4;       // first rays
};

// Returns the way of least cost for a given error. A ray like the first ones costs `cost_of_first`;
// its variance is the planned one, or the tested one if that is larger. All other ways are assumed
// to have at least this variance. A way whose test rays bring less than half the light that the
// first rays have seen is excluded. Its missing light may arrive by rays so rare and bright that no
// test shows their variance, such as samples of a lamp behind a pinhole. most_even: as in
// samples_for() (sample_spread.h).
FurtherChoice choose_further_way(std::span<const TestPixel> pixels, double cost_of_first,
                                 std::span<const TestedWay> tested, double most_even);

}  // namespace troffer
