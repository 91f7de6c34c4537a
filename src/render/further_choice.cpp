#include "render/further_choice.h"

#include <algorithm>

#include "base/error.h"
#include "base/units.h"

namespace troffer {

namespace {

// Variance of one ray over the squared allowed error, summed over the test pixels.
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
  return variance +
         sqr(std::max(missing, 0.0) / count) * double(tested.luminances.size()) / 3 * count;
}

}  // namespace

FurtherChoice choose_further_way(std::span<const TestPixel> pixels,
                                 std::span<const TestedWay> tested) {
  TROFFER_CHECK(!pixels.empty() && !tested.empty());
  constexpr double least_times = 0.25;  // a few test rays cannot show less
  double of_first = 0;
  for (const TestPixel& p : pixels) of_first += p.variance / sqr(p.allowed);
  FurtherChoice best{tested.front().way, 1};
  if (!(of_first > 0)) return best;
  double least = 0;
  for (const TestedWay& t : tested) {
    const double times = std::max(variance_of(pixels, t) / of_first, least_times);
    if (least > 0 && times * t.cost >= least) continue;
    least = times * t.cost;
    best = {t.way, times, true};
  }
  return best;
}

}  // namespace troffer
