#include "render/further_choice.h"

#include <algorithm>

#include "base/error.h"
#include "base/units.h"
#include "render/sample_spread.h"

namespace troffer {

namespace {

// Result of the test rays of a way, over the allowed error: mean luminance, and variance of one
// ray.
struct TestResult {
  double mean = 0, variance = 0, rays = 0;
};

// Returns the means over the test pixels.
TestResult seen_by(std::span<const TestPixel> pixels, const TestedWay& tested) {
  const auto count = double(pixels.size());
  TestResult seen;
  for (size_t p = 0; p < pixels.size(); ++p) {
    const auto n = double(tested.luminances[p].size());
    double sum = 0, squares = 0;
    for (const double v : tested.luminances[p]) {
      sum += v;
      squares += sqr(v);
    }
    seen.rays += n;
    seen.variance +=
        std::max(squares - sqr(sum) / n, 0.0) / (n - 1) / sqr(pixels[p].allowed) / count;
    seen.mean += sum / n / pixels[p].allowed / count;
  }
  return seen;
}

// Returns the variance of a ray, over the squared allowed error, for which so many are planned: the
// inverse of samples_for().
double planned_variance(double rays, double most_even) {
  return most_even > 0 && rays > sqr(most_even) ? sqr(rays / most_even) : rays;
}

}  // namespace

FurtherChoice choose_further_way(std::span<const TestPixel> pixels, double cost_of_first,
                                 std::span<const TestedWay> tested, double most_even) {
  TROFFER_CHECK(pixels.size() == test_pixels);
  const auto count = double(pixels.size());
  constexpr double least_missing = 0.1;
  double planned = 0, expected = 0, of_first = 0, first_rays = 0;
  for (const TestPixel& p : pixels) {
    first_rays += p.rays;
    planned += p.planned / count;
    expected += p.luminance / p.allowed / count;
    of_first += planned_variance(p.planned, most_even) / count;
  }
  TROFFER_CHECK(planned > 0);
  const double error_of_expected = std::sqrt(of_first / first_rays);
  FurtherChoice best{further_ways.front(), planned, 1, planned * cost_of_first};
  double least = of_first * cost_of_first;
  for (const TestedWay& t : tested) {
    const TestResult seen = seen_by(pixels, t);
    // Light that no test ray has brought comes with a chance of at most 3 / n (95 %).
    const double missing = std::max(expected - seen.mean, 0.0), rare = sqr(missing) * seen.rays / 3,
                 variance = std::max(seen.variance + rare, of_first),
                 work = variance * t.cost_of_ray;
    const double noise = std::hypot(error_of_expected, std::sqrt(seen.variance / seen.rays));
    const bool may_miss_light =
        2 * seen.mean < expected || missing > least_missing * expected + 2 * noise;
    if (may_miss_light || work >= least) continue;
    least = work;
    const double rays = samples_for({.chance = variance}, 1, most_even, 0);
    best = {t.way, rays, rays / planned, rays * t.cost_of_ray};
  }
  return best;
}

}  // namespace troffer
