// Searches that begin in a guide table against std::upper_bound.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/random.h"
#include "light/guide_table.h"

using namespace troffer;

namespace test_guide_table {

namespace {

// Weights between 1e-6 and 1, of which the share `zeros` is 0, in runs.
std::vector<double> random_weights(size_t n, float zeros, Random& r) {
  std::vector<double> weights(n);
  bool is_zero = false;
  for (double& w : weights) {
    if (r.next_float() < 0.3f) is_zero = r.next_float() < zeros;
    w = is_zero ? 0 : std::pow(10.0, -6.0 * double(r.next_float()));
  }
  return weights;
}

// Numbers in [0,1): random ones, both ends, the edges of all steps and their neighbours.
std::vector<float> numbers(const std::vector<float>& cdf, Random& r) {
  std::vector<float> all{0, std::nextafter(1.0f, 0.0f)};
  for (int i = 0; i < 1000; ++i) all.push_back(r.next_float());
  for (const float edge : cdf)
    for (const float u : {std::nextafter(edge, 0.0f), edge, std::nextafter(edge, 1.0f)})
      if (u >= 0 && u < 1) all.push_back(u);
  return all;
}

}  // namespace

TEST_CASE("a search from the guide finds the step that std::upper_bound finds") {
  Random r(5);
  for (const size_t n : {1u, 2u, 3u, 17u, 256u, 3001u})
    for (const float zeros : {0.0f, 0.5f, 0.95f}) {
      std::vector<double> weights = random_weights(n, zeros, r);
      weights[size_t(r.next_float() * float(n))] = 1;  // one of them is positive
      std::vector<float> cdf(n + 1);
      double sum = 0;
      for (const double w : weights) sum += w;
      CHECK(fill_cdf(weights, cdf.data()) == doctest::Approx(sum));
      CHECK(cdf.front() == 0);
      CHECK(cdf.back() == 1);
      CHECK(std::is_sorted(cdf.begin(), cdf.end()));
      std::vector<uint32_t> guide(n);
      fill_guide(cdf.data(), n, guide.data());
      size_t wrong = 0;
      for (const float u : numbers(cdf, r)) {
        float rest = u;
        const size_t i = size_t(choose_step(cdf.data(), guide.data(), n, rest));
        const auto above = std::upper_bound(cdf.begin(), cdf.end(), u);
        const float expected = (u - cdf[i]) / (cdf[i + 1] - cdf[i]);
        const bool is_right = i + 1 == size_t(above - cdf.begin()) && weights[i] > 0 &&
                              std::abs(rest - expected) <= 1e-6f;
        wrong += is_right ? 0 : 1;
      }
      CAPTURE(n);
      CAPTURE(zeros);
      CHECK(wrong == 0);
    }
}

TEST_CASE("steps of weight zero at either end have no width") {
  const std::vector<double> weights{0, 0, 0.1, 0.2, 0.7, 0, 0};
  std::vector<float> cdf(weights.size() + 1);
  fill_cdf(weights, cdf.data());
  CHECK(cdf[2] == 0);
  CHECK(cdf[3] == doctest::Approx(0.1));
  CHECK(cdf[5] == 1);
  CHECK(cdf[6] == 1);
}

TEST_CASE("an average search passes at most two steps, whatever the weights") {
  // Chen and Asau: with as many guides as steps, fewer than one step is passed on average beyond
  // the one that holds the number.
  Random r(6);
  const size_t n = 4096;
  const std::vector<double> weights = random_weights(n, 0.5f, r);
  std::vector<float> cdf(n + 1);
  fill_cdf(weights, cdf.data());
  std::vector<uint32_t> guide(n);
  fill_guide(cdf.data(), n, guide.data());
  double passed = 0;
  const int searches = 100000;
  for (int k = 0; k < searches; ++k) {
    float u = r.next_float();
    const size_t from = guide[size_t(u * float(n))];
    const size_t to = size_t(choose_step(cdf.data(), guide.data(), n, u));
    passed += std::abs(double(to) - double(from));
  }
  CHECK(passed / searches < 1.02);
}

}  // namespace test_guide_table
