#include <doctest/doctest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "base/random.h"
#include "transport/allowed_error.h"

using namespace troffer;

TEST_CASE(
    "bright pixels are judged relative to their own luminance, dark ones by the typical one") {
  CHECK(allowed_error(0.1, 0.01, 2) == doctest::Approx(0.2));
  CHECK(allowed_error(0.1, 2, 2) == doctest::Approx(0.2));
  CHECK(allowed_error(0.1, 6, 2) == doctest::Approx(0.6));
  CHECK(allowed_error(0.1, 80, 2) == doctest::Approx(0.8));
  CHECK(allowed_error(0.1, 3, 0) == doctest::Approx(0.3));
}

TEST_CASE("the usual luminance leaves out the brightest twentieth") {
  std::vector<double> values(95, 1.0);
  values.resize(100, 1000.0);
  CHECK(usual_luminance(values) == doctest::Approx(1));
}

namespace {

// Mean square of the errors, in units of the allowed one, where a pixel that alone needs wanted[i]
// samples gets n[i] and the variance falls as n^-b.
double mean_square(const std::vector<double>& wanted, const std::vector<double>& n, double b) {
  double sum = 0;
  for (size_t i = 0; i < n.size(); ++i) sum += std::pow(wanted[i] / n[i], b);
  return sum / double(n.size());
}

double total(const std::vector<double>& n) {
  return std::accumulate(n.begin(), n.end(), 0.0);
}

// Moves samples between pixels i and j so that their errors together stay what they are and their
// samples together become fewest, by golden section.
void exchange(const std::vector<double>& wanted, std::vector<double>& n, double b, size_t i,
              size_t j) {
  const double both = std::pow(wanted[i] / n[i], b) + std::pow(wanted[j] / n[j], b);
  const auto other = [&](double of_i) {
    const double left = both - std::pow(wanted[i] / of_i, b);
    return left > 0 ? wanted[j] * std::pow(left, -1 / b) : 1e300;
  };
  double low = wanted[i] * std::pow(both, -1 / b), high = low + 4 * (n[i] + n[j]);
  const double golden = (std::sqrt(5.0) - 1) / 2;
  for (int k = 0; k < 200; ++k) {
    const double a = high - golden * (high - low), c = low + golden * (high - low);
    (a + other(a) < c + other(c) ? high : low) = a + other(a) < c + other(c) ? c : a;
  }
  n[i] = (low + high) / 2;
  n[j] = other(n[i]);
}

}  // namespace

TEST_CASE("samples in proportion to share_of_samples() are the fewest for a mean square error") {
  Random random(3);
  for (const double evenness : {0.0, 0.4, 1.0}) {
    const double b = 1 + evenness;
    std::vector<double> wanted(12);
    for (double& w : wanted) w = std::pow(10.0, 4 * double(random.next_float()));
    const double p = proportion_of_samples(wanted, evenness);
    std::vector<double> n;
    for (const double w : wanted) n.push_back(p * share_of_samples(w, evenness));
    // The allowed error is met exactly.
    CHECK(mean_square(wanted, n, b) == doctest::Approx(1));
    // A numerical search that starts with the same error in every pixel ends at the same total.
    std::vector<double> found = wanted;
    for (int sweep = 0; sweep < 60; ++sweep)
      for (size_t i = 0; i + 1 < found.size(); ++i)
        exchange(wanted, found, b, i, i + 1 + size_t(sweep) % (found.size() - 1 - i));
    CAPTURE(evenness);
    CHECK(mean_square(wanted, found, b) == doctest::Approx(1).epsilon(1e-6));
    CHECK(total(found) == doctest::Approx(total(n)).epsilon(1e-4));
    CHECK(total(n) < 0.9 * total(wanted));  // fewer than with the same error in every pixel
  }
}

TEST_CASE("pixels with the same noise get what each of them wants; no pixels get none") {
  for (const double evenness : {0.0, 0.7}) {
    const std::vector<double> wanted(5, 37.0);
    CHECK(proportion_of_samples(wanted, evenness) * share_of_samples(37, evenness) ==
          doctest::Approx(37));
    CHECK(proportion_of_samples({}, evenness) == 0);
  }
}
