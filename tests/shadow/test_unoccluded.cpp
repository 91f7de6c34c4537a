// Compares unoccluded light of many receivers with quadrature: slivers, grazing horizons, receivers
// near the source's plane, far away, and far from the origin.
#include "shadow/unoccluded.h"

#include <doctest/doctest.h>

#include <cmath>

#include "light/polygon.h"
#include "support/irradiance_reference.h"

using namespace troffer;
using namespace troffer::test;

namespace {

constexpr double least = 1e-10 * pi;  // smallest irradiance that is compared

float alone(const std::vector<Vec3d>& outline, const Vec3d& m, const Vec3& x, const Vec3& n) {
  ReceiverArrays receivers;
  receivers.assign(1);
  receivers.set(0, x, n);
  float value = 0;
  unoccluded_irradiance(outline, m, receivers, &value);
  return value;
}

}  // namespace

TEST_CASE("a strip of 10 m x 1 cm from 20 m away, low over the horizon") {
  const std::vector<Vec3d> strip{{20, -5, 0.005}, {20, 5, 0.005}, {20, 5, 0.015}, {20, -5, 0.015}};
  const double expected = polygon_reference(strip, {-1, 0, 0}, {0, 0, 0}, {0, 0, 1});
  CHECK(expected > least);
  CHECK(double(alone(strip, {-1, 0, 0}, {0, 0, 0}, {0, 0, 1})) ==
        doctest::Approx(expected).epsilon(1e-5));
}

TEST_CASE("unoccluded light keeps its precision") {
  double worst = 0;
  int compared = 0;
  for (uint64_t seed = 0; seed < 3000; ++seed) {
    Random r(seed + 50);
    const RandomPolygon p = random_polygon(r);
    const double offset = seed % 3 == 0 ? 0 : seed % 3 == 1 ? 1000 : 5000;
    std::vector<Vec3d> outline;
    for (const Vec3d& c : p.corners) outline.push_back(c + Vec3d{offset, offset, 0});
    const Vec3d m = p.m, origin = outline[size_t(r.next_double() * 3)];
    // one block: easy and hard receivers side by side
    constexpr size_t n = 16;
    ReceiverArrays receivers;
    receivers.assign(n);
    std::vector<HardReceiver> hard;
    for (size_t i = 0; i < n; ++i) {
      hard.push_back(hard_receiver(r, origin, m, p.size));
      receivers.set(i, hard[i].position, hard[i].normal);
    }
    float values[n];
    unoccluded_irradiance(outline, m, receivers, values);
    for (const size_t i : {size_t(r.next_double() * n), size_t(r.next_double() * n)}) {
      const Vec3d x(hard[i].position);
      // receivers in the source's plane, up to rounding, get no light (light/polygon.h)
      if (dot(m, x - outline[0]) < 1.01 * plane_rounding(x, outline[0])) continue;
      const double expected = polygon_reference(outline, m, x, Vec3d(hard[i].normal));
      if (!(expected > least)) continue;
      ++compared;
      worst = std::max(worst, std::abs(double(values[i]) / expected - 1));
    }
  }
  MESSAGE(compared, " values, worst ", worst);
  CHECK(compared > 2000);
  CHECK(worst < 1e-4);
}
