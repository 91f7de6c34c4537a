#include "render/further_choice.h"

#include <algorithm>

#include "base/error.h"
#include "base/units.h"
#include "render/sample_spread.h"

namespace troffer {

namespace {

// Mean over the test pixels of the variance of one ray over the squared allowed error.
double variance_of(std::span<const TestPixel> pixels, const TestedWay& tested) {
  const size_t rays = tested.luminances.size() / pixels.size();
  double variance = 0, missing = 0;
  for (size_t p = 0; p < pixels.size(); ++p) {
    double sum = 0, squares = 0;
    for (size_t i = 0; i < rays; ++i) {
      const double v = tested.luminances[p * rays + i];
      sum += v;
      squares += sqr(v);
    }
    const auto n = double(rays);
    variance += std::max(squares - sqr(sum) / n, 0.0) / (n - 1) / sqr(pixels[p].allowed);
    missing += (pixels[p].luminance - sum / n) / pixels[p].allowed;
  }
  const auto count = double(pixels.size());
  return variance / count +
         sqr(std::max(missing, 0.0) / count) * double(tested.luminances.size()) / 3;
}

}  // namespace

FurtherChoice choose_further_way(std::span<const TestPixel> pixels,
                                 std::span<const TestedWay> tested, double most_even) {
  TROFFER_CHECK(!pixels.empty() && !tested.empty());
  double planned = 0;
  for (const TestPixel& p : pixels) planned += p.planned / double(pixels.size());
  TROFFER_CHECK(planned > 0);
  FurtherChoice best{tested.front().way};
  double least = 0;
  for (const TestedWay& t : tested) {
    const double variance = variance_of(pixels, t), work = variance * t.cost;
    if (best.is_tested && work >= least) continue;
    least = work;
    best = {t.way, true, samples_for({.chance = variance}, 1, most_even, 0), 1};
  }
  best.times = best.rays / planned;
  return best;
}

}  // namespace troffer
