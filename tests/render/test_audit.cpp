// Measurements beside others that trust nothing: what is told of a bias.
#include <doctest/doctest.h>

#include <cmath>

#include "base/random.h"
#include "render/audit.h"
#include "support/statistics.h"

using namespace troffer;
using namespace troffer::test;

namespace {

double normal(Random& random) {
  return std::sqrt(-2 * std::log(1 - random.next_double())) *
         std::cos(2 * pi * random.next_double());
}

struct Lists {
  std::vector<Measurement> points, others;
};

// Points of 50 to 550 lx, known within one and within three percent; the first are off by a bias
// of random sign.
Lists lists(int points, double bias, Random& random) {
  Lists l;
  for (int i = 0; i < points; ++i) {
    const double truth = 50 + 500 * random.next_double();
    const double off = random.next_double() < 0.5 ? -bias : bias;
    Measurement& a = l.points.emplace_back();
    a.standard_error = 0.01 * truth;
    a.illuminance_lx = truth * (1 + off) + a.standard_error * normal(random);
    Measurement& b = l.others.emplace_back();
    b.standard_error = 0.03 * truth;
    b.illuminance_lx = truth + b.standard_error * normal(random);
  }
  return l;
}

}  // namespace

TEST_CASE("audit: lists that agree are found fault with once in a hundred times") {
  Random random(4);
  for (const int points : {1, 5, 32}) {
    int alarms = 0;
    for (int k = 0; k < 10'000; ++k) {
      const Lists l = lists(points, 0, random);
      alarms += relative_bias(l.points, l.others) > 0 ? 1 : 0;
    }
    CAPTURE(points);
    CHECK(alarms > 60);
    CHECK(alarms < 160);
  }
}

TEST_CASE("audit: a bias is told about as large as it is") {
  Random random(5);
  for (const double bias : {0.05, 0.1, 0.3}) {
    double squares = 0;
    for (int k = 0; k < 1000; ++k) {
      const Lists l = lists(32, bias, random);
      squares += std::pow(relative_bias(l.points, l.others), 2) / 1000;
    }
    CAPTURE(bias);
    CHECK(std::sqrt(squares) == doctest::Approx(bias).epsilon(0.1));
  }
}

TEST_CASE("audit: dark points, and others without an error, have no say") {
  std::vector<Measurement> points(2), others(2);
  others[0].illuminance_lx = 5;
  others[0].standard_error = 1;
  points[1].illuminance_lx = 100;
  others[1].illuminance_lx = 50;
  CHECK(relative_bias(points, others) == 0);
  CHECK(relative_bias({}, {}) == 0);
  others[1].standard_error = 1;
  CHECK(relative_bias(points, others) == doctest::Approx(0.5).epsilon(0.01));
  add_error(points, 0.5);
  CHECK(points[1].standard_error == doctest::Approx(50));
}
