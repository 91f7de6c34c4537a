// Tests of means: Student's t, running moments.
// References: [1] Press et al., "Numerical Recipes", 3rd ed., §6.4 (incomplete beta function),
//   §6.14 (Student's distribution). [2] Welford, "Note on a Method for Calculating Corrected Sums
//   of Squares and Products", Technometrics 4(3), 1962.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace troffer::test {

// Regularized incomplete beta function I_x(a, b), 0 <= x <= 1, by Lentz's method [1].
inline double beta_i(double a, double b, double x) {
  if (!(x > 0)) return 0;
  if (!(x < 1)) return 1;
  if (x > (a + 1) / (a + b + 2)) return 1 - beta_i(b, a, 1 - x);
  constexpr double tiny = 1e-300;
  const auto safe = [](double v) { return std::abs(v) < tiny ? tiny : v; };
  double c = 1, d = 1 / safe(1 - (a + b) * x / (a + 1)), h = d;
  for (int m = 1; m < 10000; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1 / safe(1 + even * d);
    c = safe(1 + even / c);
    h *= d * c;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1 / safe(1 + odd * d);
    c = safe(1 + odd / c);
    h *= d * c;
    if (std::abs(d * c - 1) < 1e-15) break;
  }
  const double log_front =
      std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x);
  return std::exp(log_front) * h / a;
}

// Returns the probability that |t| is at least this large, for n degrees of freedom.
inline double student_p(double t, double n) {
  return std::isnan(t) ? 0 : beta_i(n / 2, 0.5, n / (n + t * t));
}

// Running mean and variance [2].
class Moments {
 public:
  void add(double value) {
    ++count_;
    const double before = value - mean_;
    mean_ += before / double(count_);
    squares_ += before * (value - mean_);
  }
  size_t count() const { return count_; }
  double mean() const { return mean_; }
  double variance_of_mean() const {
    return count_ < 2 ? std::numeric_limits<double>::infinity()
                      : squares_ / double(count_ - 1) / double(count_);
  }
  double standard_error() const { return std::sqrt(variance_of_mean()); }

 private:
  size_t count_ = 0;
  double mean_ = 0, squares_ = 0;
};

// Returns the probability that a mean is at least this far from `expected` by chance. `rounding`:
// error of the values for other reasons, which is subtracted first.
inline double p_of_mean(const Moments& m, double expected, double rounding = 0) {
  const double off = std::max(0.0, std::abs(m.mean() - expected) - rounding);
  if (off == 0) return 1;
  return student_p(off / std::max(m.standard_error(), 1e-300), double(m.count() - 1));
}
// Returns the probability of a difference of two means at least this large by chance (n: the
// smaller count minus one).
inline double p_of_difference(const Moments& a, const Moments& b, double rounding = 0) {
  const double off = std::max(0.0, std::abs(a.mean() - b.mean()) - rounding);
  if (off == 0) return 1;
  const double error = std::sqrt(a.variance_of_mean() + b.variance_of_mean());
  return student_p(off / std::max(error, 1e-300), double(std::min(a.count(), b.count()) - 1));
}

}  // namespace troffer::test
