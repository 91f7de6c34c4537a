#include "render/further_choice.h"

#include <algorithm>

#include "base/error.h"
#include "base/units.h"
#include "render/sample_spread.h"

namespace troffer {

namespace {

// What the test rays of a way saw, over the allowed error: mean luminance, and variance of one ray.
struct TestResult {
  double mean = 0, variance = 0;
};

// Returns the means over the test pixels.
TestResult seen_by(std::span<const TestPixel> pixels, const TestedWay& tested) {
  const size_t rays = tested.luminances.size() / pixels.size();
  const auto n = double(rays), count = double(pixels.size());
  TestResult seen;
  for (size_t p = 0; p < pixels.size(); ++p) {
    double sum = 0, squares = 0;
    for (size_t i = 0; i < rays; ++i) {
      const double v = tested.luminances[p * rays + i];
      sum += v;
      squares += sqr(v);
    }
    seen.variance +=
        std::max(squares - sqr(sum) / n, 0.0) / (n - 1) / sqr(pixels[p].allowed) / count;
    seen.mean += sum / n / pixels[p].allowed / count;
  }
  return seen;
}

}  // namespace

FurtherChoice choose_further_way(std::span<const TestPixel> pixels,
                                 std::span<const TestedWay> tested, double most_even) {
  TROFFER_CHECK(!pixels.empty() && !tested.empty());
  double planned = 0, expected = 0;
  for (const TestPixel& p : pixels) {
    planned += p.planned / double(pixels.size());
    expected += p.luminance / p.allowed / double(pixels.size());
  }
  TROFFER_CHECK(planned > 0);
  FurtherChoice best{tested.front().way};
  double least = 0;
  for (const TestedWay& t : tested) {
    const TestResult seen = seen_by(pixels, t);
    const double work = seen.variance * t.cost;
    const bool may_miss_light = 2 * seen.mean < expected;
    if (best.is_tested && (may_miss_light || work >= least)) continue;
    least = work;
    best = {t.way, true, samples_for({.chance = seen.variance}, 1, most_even, 0), 1};
  }
  best.times = best.rays / planned;
  return best;
}

}  // namespace troffer
