#include "report/statistics.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/units.h"

namespace troffer {

namespace {

// Returns a standard normal number from two uniform ones (Box & Muller).
double next_normal(Random& random) {
  const double u = 1 - random.next_double(), v = random.next_double();
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * pi * v);
}

// Estimates the bias of the minimum by a parametric bootstrap with a fixed seed.
double bias_of_least(const std::vector<Figure>& values, double least) {
  constexpr int draws = 256;
  Random random(1);
  double sum = 0;
  for (int d = 0; d < draws; ++d) {
    double drawn = 1e300;
    for (const Figure& f : values) drawn = std::min(drawn, f.value + f.error * next_normal(random));
    sum += drawn - least;
  }
  return std::min(0.0, sum / draws);
}

}  // namespace

Figure mean_of(const std::vector<Figure>& values) {
  Figure mean;
  for (const Figure& f : values) mean = {mean.value + f.value, mean.error + f.error};
  return values.empty() ? mean : scaled(mean, 1.0 / double(values.size()));
}

Figure ratio(const Figure& a, const Figure& b) {
  if (!(b.value > 0)) return {};
  const double r = a.value / b.value;
  return {r, std::hypot(a.error, r * b.error) / b.value};
}

Figure sum(const Figure& a, const Figure& b) {
  return {a.value + b.value, std::hypot(a.error, b.error)};
}

GridSummary summary_of(const std::vector<Figure>& values) {
  GridSummary s;
  if (values.empty()) return s;
  s.has_values = true;
  s.mean = mean_of(values);
  const auto [least, most] =
      std::minmax_element(values.begin(), values.end(),
                          [](const Figure& a, const Figure& b) { return a.value < b.value; });
  s.least = *least;
  s.most = *most;
  s.uniformity = ratio(s.least, s.mean);
  s.least_bias = bias_of_least(values, s.least.value);
  return s;
}

}  // namespace troffer
