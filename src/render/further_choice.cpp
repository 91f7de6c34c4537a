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

// Returns what first rays see: by the first pass, and by test rays of the same kind if there are
// any. The variance is at least the planned one, which counts what a pixel's neighbours show.
TestResult seen_by_first_rays(std::span<const TestPixel> pixels, std::span<const TestedWay> tested,
                              double most_even) {
  const auto count = double(pixels.size());
  TestResult first;
  for (const TestPixel& p : pixels) {
    first.rays += p.rays;
    first.mean += p.luminance / p.allowed / count;
    first.variance += planned_variance(p.planned, most_even) / count;
  }
  for (const TestedWay& t : tested) {
    if (!t.way.is_like_first) continue;
    const TestResult seen = seen_by(pixels, t);
    const double rays = first.rays + seen.rays, share = seen.rays / rays;
    first.mean += share * (seen.mean - first.mean);
    first.variance += share * std::max(seen.variance - first.variance, 0.0);
    first.rays = rays;
  }
  return first;
}

}  // namespace

FurtherChoice choose_further_way(std::span<const TestPixel> pixels, double cost_of_first,
                                 std::span<const TestedWay> tested, double most_even) {
  TROFFER_CHECK(pixels.size() == test_pixels);
  constexpr double least_missing = 0.1;
  const TestResult first = seen_by_first_rays(pixels, tested, most_even),
                   untested = seen_by_first_rays(pixels, {}, most_even);
  double planned = 0;
  for (const TestPixel& p : pixels) planned += p.planned / double(pixels.size());
  TROFFER_CHECK(planned > 0);
  const auto samples = [&](double variance) {
    return samples_for({.chance = variance}, 1, most_even, 0);
  };
  // More first rays than planned if their tests show more variance. A way that varies more than
  // they do takes more rays, for the same error.
  const double times_of_first = samples(first.variance) / samples(untested.variance);
  const auto choice = [&](const FurtherWay& way, double variance, double cost) {
    const double times = times_of_first * variance / first.variance;
    return FurtherChoice{way, planned * times, times, planned * times * cost};
  };
  FurtherChoice best = choice(further_ways.front(), first.variance, cost_of_first);
  double least = first.variance * cost_of_first;
  for (const TestedWay& t : tested) {
    if (t.way.is_like_first) continue;
    const TestResult seen = seen_by(pixels, t);
    // Light that no test ray has brought comes with a chance of at most 3 / n (95 %).
    const double missing = std::max(first.mean - seen.mean, 0.0),
                 rare = sqr(missing) * seen.rays / 3,
                 variance = std::max(seen.variance + rare, first.variance),
                 work = variance * t.cost_of_ray,
                 noise = std::sqrt(first.variance / first.rays + seen.variance / seen.rays);
    const bool may_miss_light =
        2 * seen.mean < first.mean || missing > least_missing * first.mean + 2 * noise;
    if (may_miss_light || work >= least) continue;
    least = work;
    best = choice(t.way, variance, t.cost_of_ray);
  }
  return best;
}

}  // namespace troffer
