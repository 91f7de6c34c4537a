// Pearson's χ² goodness-of-fit test with pooling of bins of low expectation, and the Šidák
// correction for many simultaneous tests.
// References: [1] Press et al., "Numerical Recipes", 3rd ed., §6.2 (incomplete gamma function).
//   [2] Šidák, "Rectangular Confidence Regions for the Means of Multivariate Normal
//       Distributions", JASA 62(318), 1967.
//
// Usage: count n samples into bins (`observed`), integrate n × density over the same bins
// (`expected`), and call
//     const double significance = sidak(1e-4, number_of_tests);
//     const auto r = chi_square_test(observed, expected, 1, significance);
//     CHECK_MESSAGE(r.is_accepted, r.text());
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <vector>

namespace troffer::test {

// Regularized upper incomplete gamma function Q(a, x) = Γ(a, x) / Γ(a), a > 0, x >= 0 [1].
inline double gamma_q(double a, double x) {
  if (!(x > 0)) return 1;
  const double log_factor = -x + a * std::log(x) - std::lgamma(a);
  if (x < a + 1) {  // series of the lower function
    double term = 1 / a, sum = term;
    for (double k = a + 1; std::abs(term) > std::abs(sum) * 1e-16; k += 1) {
      term *= x / k;
      sum += term;
    }
    return std::clamp(1 - sum * std::exp(log_factor), 0.0, 1.0);
  }
  // continued fraction by Lentz's method
  constexpr double tiny = 1e-300;
  double b = x + 1 - a, c = 1 / tiny, d = 1 / b, h = d;
  for (int i = 1; i < 100000; ++i) {
    const double an = -i * (i - a);
    b += 2;
    d = an * d + b;
    if (std::abs(d) < tiny) d = tiny;
    c = b + an / c;
    if (std::abs(c) < tiny) c = tiny;
    d = 1 / d;
    const double step = d * c;
    h *= step;
    if (std::abs(step - 1) < 1e-15) break;
  }
  return std::clamp(std::exp(log_factor) * h, 0.0, 1.0);
}

// Returns the significance of each of `tests` independent tests, such that all together reject a
// true hypothesis with probability `significance` [2].
inline double sidak(double significance, int tests) {
  return -std::expm1(std::log1p(-significance) / tests);
}

struct ChiSquareResult {
  double statistic = 0;
  int degrees_of_freedom = 0;  // 0: too few samples or bins for a test
  // probability of a statistic at least this large under the hypothesis
  double p_value = 1;
  double stray = 0;  // samples in bins of expectation 0
  bool is_accepted = true;

  std::string text() const {
    char buffer[160];
    std::snprintf(buffer, sizeof(buffer), "chi² %.1f, %d degrees of freedom, p %.3g, stray %.0f",
                  statistic, degrees_of_freedom, p_value, stray);
    return buffer;
  }
};

// Tests whether the counts `observed` are drawn from a distribution with means `expected` (same
// length; both are counts, not probabilities). Bins of expectation under `min_expected` are pooled,
// smallest first.
//
// dof_reduction: number of parameters of `expected` that were fitted to the counts. It is 1 if both
// have the same sum by construction; sums that differ by more than 1e-3 (a density that does not
// integrate to one) are then rejected. Also rejects more than 3 samples + 1e-5 of all in bins of
// expectation 0, since rounding at bin edges produces fewer. Rejects NaN.
inline ChiSquareResult chi_square_test(std::span<const double> observed,
                                       std::span<const double> expected, int dof_reduction,
                                       double significance, double min_expected = 5) {
  ChiSquareResult r;
  const double total_observed = std::accumulate(observed.begin(), observed.end(), 0.0);
  const double total_expected = std::accumulate(expected.begin(), expected.end(), 0.0);
  std::vector<size_t> order(observed.size());
  std::iota(order.begin(), order.end(), size_t(0));
  std::sort(order.begin(), order.end(),
            [&](size_t i, size_t j) { return expected[i] < expected[j]; });

  struct Bin {
    double observed = 0, expected = 0;
  };
  std::vector<Bin> bins;
  Bin pool;
  for (const size_t i : order) {
    if (!(expected[i] > 0)) r.stray += observed[i];
    pool.observed += observed[i];
    pool.expected += expected[i];
    if (pool.expected >= min_expected) {
      bins.push_back(pool);
      pool = {};
    }
  }
  if (!bins.empty()) {
    bins.back().observed += pool.observed;
    bins.back().expected += pool.expected;
  }
  for (const Bin& b : bins) {
    const double difference = b.observed - b.expected;
    r.statistic += difference * difference / b.expected;
  }
  r.degrees_of_freedom = std::max(0, int(bins.size()) - dof_reduction);
  if (r.degrees_of_freedom > 0) r.p_value = gamma_q(0.5 * r.degrees_of_freedom, 0.5 * r.statistic);
  const bool sums_agree = dof_reduction == 0 || std::abs(total_observed - total_expected) <=
                                                    1e-3 * std::max(total_observed, 1.0);
  // written so that a NaN rejects
  r.is_accepted = sums_agree && std::isfinite(r.statistic) &&
                  r.stray <= 3 + 1e-5 * total_observed && r.p_value >= significance;
  return r;
}

}  // namespace troffer::test
