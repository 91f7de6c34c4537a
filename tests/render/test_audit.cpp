// Audit of measurements: detection of a bias, its addition to errors, and replacement of biased
// values.
#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <memory>

#include "base/random.h"
#include "render/audit.h"
#include "render/blinds_in_the_sun.h"
#include "support/statistics.h"
#include "support/surfaceless_lights.h"

using namespace troffer;
using namespace troffer::test;

namespace test_audit {

namespace {

double normal(Random& random) {
  return std::sqrt(-2 * std::log(1 - random.next_double())) *
         std::cos(2 * pi * random.next_double());
}

struct Lists {
  std::vector<Measurement> points, others;
};

// Points of 50 to 550 lx with standard errors of one and three percent in the two lists. The first
// list has a bias of random sign.
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

const StopFlag never_stopped = false;

MeasureOptions by_cells(int threads) {
  MeasureOptions o;
  o.indirect = Indirect::cells;
  o.threads = threads;
  return o;
}

// An integrator that finds light of 1, with an error of a tenth per sample. The first sensors have
// the bias `at_first`, later ones the bias `then`.
class TwoLooks final : public Integrator {
 public:
  TwoLooks(double at_first, double then, uint64_t first_sensors)
      : at_first_(at_first), then_(then), first_sensors_(first_sensors) {}
  std::unique_ptr<IntegratorScratch> make_scratch() const override {
    return std::make_unique<IntegratorScratch>();
  }
  void radiance(const ViewingRays&, IntegratorScratch&, RadianceBatch&, Counters&) const override {}
  void irradiance(const SensorBatch& sensors, IntegratorScratch&, RadianceBatch& out,
                  Counters&) const override {
    for (size_t i = 0; i < sensors.size(); ++i) {
      Random random(hash_of(sensors.streams[i], sensors.samples[i]));
      const double off = seen_++ < first_sensors_ ? at_first_ : then_;
      out.indirect[i] = Rgb{float(1 + off + 0.1 * normal(random))};
    }
  }
  uint64_t seen() const { return seen_; }

 private:
  double at_first_, then_;
  uint64_t first_sensors_;
  mutable std::atomic<uint64_t> seen_{0};
};

}  // namespace

TEST_CASE("audit: a suspicion from the first test is decided by a second test") {
  constexpr size_t points = 32;
  constexpr int samples = 64;
  constexpr uint64_t first = points * samples * 4, both = first + points * samples * 16;
  const std::vector<MeasuringPlace> places(points);
  std::vector<PointLight> by_cells(points);
  for (PointLight& p : by_cells) p.all = p.indirect = {Rgb{0}, 1, 0.002};
  const PointPlan plan{.samples = samples, .samples_per_estimate = 1};
  const auto found = [&](double at_first, double then, uint64_t sensors) {
    const TwoLooks paths(at_first, then, first);
    const auto finding = audit(paths, places, by_cells, plan, {5, 2, 4096, nullptr, never_stopped});
    REQUIRE(finding);
    CHECK(paths.seen() == sensors);
    return *finding;
  };
  CHECK(found(0, 0.1, first).bias == 0);  // no doubt
  const AuditFinding cleared = found(0.1, 0, both), confirmed = found(0.1, 0.1, both);
  CHECK(cleared.bias == 0);
  CHECK(confirmed.bias == doctest::Approx(0.1).epsilon(0.05));
  CHECK(!confirmed.needed_second_look);
}

TEST_CASE("audit: unbiased lists are rejected once in a hundred cases") {
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

TEST_CASE("audit: the reported bias is close to the actual bias") {
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

TEST_CASE("audit: dark points and points without an error do not count") {
  std::vector<Measurement> points(2), others(2);
  others[0].illuminance_lx = 5;
  others[0].standard_error = 1;
  points[1].illuminance_lx = 100;
  others[1].illuminance_lx = 50;
  CHECK(relative_bias(points, others) == 0);
  CHECK(relative_bias({}, {}) == 0);
  others[1].standard_error = 1;
  CHECK(relative_bias(points, others) == doctest::Approx(0.5).epsilon(0.01));
}

TEST_CASE("audit: points behind sunlit blinds agree with paths, within their intervals") {
  const PreparedScene scene(blinds_in_the_sun());
  const std::vector<MeasuringPoint> points = points_above(24);
  MeasureOptions o = by_cells(2);
  o.spp = 1024;
  const MeasureResult mine = measure(scene, points, o, {}, never_stopped);
  o.method = Method::path;
  o.indirect = Indirect::automatic;
  o.spp = 1 << 14;
  o.seed = 5;
  const MeasureResult paths = measure(scene, points, o, {}, never_stopped);
  double sum = 0, expected = 0, variance = 0, told = 0;
  int inside = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const Measurement &a = mine.values[i], &b = paths.values[i];
    const double error = std::hypot(a.standard_error, b.standard_error);
    inside += std::abs(a.illuminance_lx - b.illuminance_lx) <= 1.96 * error ? 1 : 0;
    sum += a.illuminance_lx;
    expected += b.illuminance_lx;
    variance += error * error;
    told += a.standard_error / a.illuminance_lx / double(points.size());
  }
  CAPTURE(told);
  CAPTURE(sum / expected - 1);
  CAPTURE(std::sqrt(variance) / expected);
  CHECK(inside >= 20);
  CHECK(std::abs(sum - expected) < 3.5 * std::sqrt(variance));
  CHECK(told < 0.05);
}

TEST_CASE("audit: the same for any number of threads, and a stop during it is reported") {
  const PreparedScene scene(blinds_in_the_sun());
  const std::vector<MeasuringPoint> points = points_above(5);
  MeasureOptions o = by_cells(1);
  o.spp = 256;
  const MeasureResult one = measure(scene, points, o, {}, never_stopped);
  o.threads = 3;
  const MeasureResult three = measure(scene, points, o, {}, never_stopped);
  CHECK(one.is_complete);
  for (size_t i = 0; i < points.size(); ++i) {
    CHECK(one.values[i].illuminance_lx == three.values[i].illuminance_lx);
    CHECK(one.values[i].standard_error == three.values[i].standard_error);
    CHECK(one.values[i].irradiance.g == three.values[i].irradiance.g);
  }
  StopFlag stop = false;
  const auto stop_at_last = [&](double f) { stop = f >= 1; };
  CHECK_FALSE(measure(scene, points, o, stop_at_last, stop).is_complete);
}

}  // namespace test_audit
