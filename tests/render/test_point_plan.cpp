// Allocation of samples to measuring points.
#include "render/point_plan.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "base/random.h"

using namespace troffer;

namespace {

PointLight of_errors(double lx, double direct, double indirect) {
  PointLight p;
  p.all = {Rgb{}, lx, std::hypot(direct, indirect)};
  p.direct = {Rgb{}, lx / 2, direct};
  p.indirect = {Rgb{}, lx / 2, indirect};
  p.direct_part_error = direct;
  p.other_part_error = indirect;
  return p;
}

// Returns the error expected with `plan`, given what `found` has with the samples of `before`.
double error_expected(const PointLight& found, const PointPlan& before, const PointPlan& plan) {
  const double all = double(plan.samples) / before.samples;
  const double of_direct = all * before.samples_per_direct / plan.samples_per_direct;
  return std::hypot(found.direct.standard_error / std::sqrt(of_direct),
                    found.indirect.standard_error / std::sqrt(all));
}

PointPlan enough_for_one(const PointLight& found, const PointPlan& plan) {
  return enough_for(std::span(&found, 1), {plan})[0];
}

double samples_in_all(const std::vector<PointPlan>& plans) {
  double sum = 0;
  for (const PointPlan& p : plans) sum += p.samples + double(p.samples) / p.samples_per_direct;
  return sum;
}

// Points of 1 to 1000 lx; either part of each errs by 1 to 10 % of its light.
std::vector<PointLight> list(size_t points, Random& random) {
  std::vector<PointLight> l;
  for (size_t i = 0; i < points; ++i) {
    const double lx = std::pow(1000, random.next_double());
    const auto share = [&] { return 0.01 * std::pow(10, random.next_double()); };
    const double direct = lx * share();
    l.push_back(of_errors(lx, direct, lx * share()));
  }
  return l;
}

double mean_light(const std::vector<PointLight>& l) {
  double sum = 0;
  for (const PointLight& p : l) sum += p.all.illuminance_lx;
  return sum / double(l.size());
}

}  // namespace

TEST_CASE("a point with no more error than planned keeps its plan") {
  PointPlan plan{4096, 1, 32, 0.0025};
  for (const PointLight& p : {of_errors(100, 0.1, 0.2), of_errors(0, 1, 1)}) {
    CHECK(enough_for_one(p, plan).samples == 4096);
    CHECK(enough_for_one(p, plan).samples_per_direct == 32);
  }
  plan.tolerance = 2;
  CHECK(enough_for_one(of_errors(100, 0.2, 0.4), plan).samples == 4096);
  CHECK(enough_for_one(of_errors(100, 0.3, 0.5), plan).samples > 4096);
  plan.error = 0;  // exactly this number of samples
  CHECK(enough_for_one(of_errors(100, 50, 50), plan).samples == 4096);
}

TEST_CASE("plans reach the target error by more samples of the noisier kind") {
  const PointPlan before{4096, 1, 32, 0.0025};
  for (const double direct : {0.0, 0.01, 0.1, 0.5, 1.0, 2.0})
    for (const double indirect : {0.0, 0.01, 0.1, 0.5, 1.0, 2.0}) {
      const PointLight found = of_errors(100, direct, indirect);
      if (std::hypot(direct, indirect) <= 0.25) continue;
      const PointPlan plan = enough_for_one(found, before);
      CAPTURE(direct);
      CAPTURE(indirect);
      CAPTURE(plan.samples);
      CAPTURE(plan.samples_per_direct);
      CHECK(error_expected(found, before, plan) <= 0.25 * 1.0001);
      CHECK(plan.samples_per_direct >= 1);
      // Whole sets of 32, with direct light in each.
      CHECK(plan.samples % (32 * plan.samples_per_direct) == 0);
      // Not much more than needed: both parts are powers of two.
      const double least = (direct + indirect) * (direct + indirect) / (0.25 * 0.25);
      const double work = double(plan.samples) / before.samples *
                          (1 + double(before.samples_per_direct) / plan.samples_per_direct);
      CHECK(work <= 4 * (least + 2));
    }
  // If direct light alone errs, the number of other samples stays small.
  CHECK(enough_for_one(of_errors(100, 0.9, 0.001), before).samples == 4096);
  CHECK(enough_for_one(of_errors(100, 0.9, 0.001), before).samples_per_direct == 2);
  CHECK(enough_for_one(of_errors(100, 0.001, 0.9), before).samples == 16 * 4096);
  CHECK(enough_for_one(of_errors(100, 0.001, 0.9), before).samples_per_direct == 16 * 32);
}

TEST_CASE("no plan exceeds its maximum, and each kind of samples can grow alone") {
  PointPlan plan{4096, 1, 32, 0.0025};
  plan.most_times = 128;
  CHECK(enough_for_one(of_errors(100, 0, 1000), plan).samples == 128 * 4096);
  const PointPlan both = enough_for_one(of_errors(100, 1000, 0), plan);
  CHECK(both.samples / both.samples_per_direct == 128 * (4096 / 32));
  plan.samples_per_direct = 1;
  CHECK(enough_for_one(of_errors(100, 0.3, 0.4), plan).samples == 4 * 4096);
}

TEST_CASE("a list reaches the target error with nearly the minimum number of samples") {
  Random random(7);
  for (const size_t points : {2u, 20u, 300u}) {
    CAPTURE(points);
    const std::vector<PointLight> l = list(points, random);
    PointPlan before{32, 1, 2, 0.0025};  // so few that nearly all points need more
    before.most_times = 1 << 20;
    const std::vector<PointPlan> plans = enough_for(l, std::vector<PointPlan>(points, before));
    const double mean = mean_light(l);
    double squares = 0, deviations = 0, of_one = 0;
    for (size_t i = 0; i < points; ++i) {
      const double own = l[i].all.illuminance_lx, error = error_expected(l[i], before, plans[i]);
      const double weight = 0.5 / (own * own) + 0.5 / (mean * mean);
      squares += weight * error * error / double(points);
      of_one = std::max(of_one, error / own);
      deviations += std::sqrt(weight) * (l[i].direct_part_error * std::sqrt(16.0) +
                                         l[i].other_part_error * std::sqrt(32.0));
    }
    CHECK(std::sqrt(squares) <= 0.0025 * 1.0001);
    CHECK(of_one <= 2 * 0.0025 * 1.0001);
    const double least = deviations * deviations / (double(points) * 0.0025 * 0.0025);
    CHECK(samples_in_all(plans) < (points < 20 ? 2 : 1.4) * least);
  }
}

TEST_CASE("bright points are measured more accurately than their own light requires") {
  std::vector<PointLight> l(100, of_errors(1, 0, 0.01));
  l[40] = of_errors(50, 0, 0.5);  // the same relative error
  const std::vector<PointPlan> plans =
      enough_for(l, std::vector<PointPlan>(100, {4096, 1, 32, 0.0025}));
  CHECK(plans[40].samples >= 4 * plans[0].samples);
}

TEST_CASE("points that cannot be measured well are not compensated by others") {
  std::vector<PointLight> l(10, of_errors(100, 0, 0.9));
  const std::vector<PointPlan> before(10, {4096, 1, 32, 0.0025});
  const std::vector<PointPlan> without = enough_for(l, before);
  l[3] = of_errors(100, 0, 1000);
  l[4] = of_errors(100, 0, std::numeric_limits<double>::quiet_NaN());
  l[5] = of_errors(0, 0, 1);
  const std::vector<PointPlan> with = enough_for(l, before);
  CHECK(with[3].samples == 128 * 4096);
  CHECK(with[4].samples == 4096);
  CHECK(with[5].samples == 4096);
  CHECK(with[0].samples <= 2 * without[0].samples);
  CHECK(with[0].samples >= without[0].samples);
}

TEST_CASE("pilot samples only decide the number of samples") {
  PointPlan plan{4096, 1, 32, 0.0025};
  plan.first_times = 0.5;
  plan.least_times = 2;
  const PointPlan first = first_of(plan);
  CHECK(first.samples == 2048);
  CHECK(first.samples / first.samples_per_direct == 128);
  CHECK(first.samples * first.most_times == 4096 * 128);
  // The least number, if errors are as small as they may be.
  CHECK(enough_for_one(of_errors(100, 0.01, 0.01), plan).samples == 2 * 4096);
  CHECK(enough_for_one(of_errors(100, 0.01, 0.01), plan).samples_per_direct == 64);
  CHECK(enough_for_one(of_errors(0, 0, 0), plan).samples == 2 * 4096);
  CHECK(enough_for_one(of_errors(100, 0, 0.9), plan).samples == 16 * 2048);
  CHECK(enough_for_one(of_errors(100, 0, 1000), plan).samples == 128 * 4096);
  plan.error = 0;  // exactly this number of samples
  CHECK(first_of(plan).samples == 4096);
  CHECK(enough_for_one(of_errors(100, 0, 0.9), plan).samples == 4096);
}

TEST_CASE("spare samples are spent only where the error is not dominated by the shared error") {
  PointPlan plan{4096, 1, 32, 0.0025};
  std::vector<PointLight> l(10, of_errors(100, 0, 0.2));  // accurate enough already
  const std::vector<PointPlan> plans(10, plan);
  const double had = samples_in_all(plans);
  CHECK(samples_in_all(enough_for(l, plans, 0)) == had);
  CHECK(samples_in_all(enough_for(l, plans, 0.5 * had)) == had);
  const double more = samples_in_all(enough_for(l, plans, 10 * had));
  CHECK(more >= 10 * had);
  CHECK(more <= 20 * had);
  // Sixteen times as many samples reduce the error by four, down to the shared one.
  for (PointLight& p : l) p.shared_error = 0.051;
  CHECK(enough_for(l, plans, 1e9)[0].samples == 16 * 4096);
  for (PointLight& p : l) p.shared_error = 1;
  CHECK(samples_in_all(enough_for(l, plans, 1e9)) == had);
}

TEST_CASE("few light samples that were all unoccluded ask for more light samples only") {
  PointPlan plan{4096, 1, 32, 0.0025};
  plan.first_times = 0.5;
  plan.least_times = 2;
  PointLight p = of_errors(100, 0, 0.05);
  p.least_error = 0.45;
  const PointPlan alone = enough_for_one(p, plan);
  CHECK(alone.samples == 2 * 4096);
  CHECK(alone.samples / alone.samples_per_direct == 256);
  std::vector<PointLight> l(50, of_errors(100, 0.03, 0.3));
  const int without = enough_for(l, std::vector<PointPlan>(50, plan))[0].samples;
  l.insert(l.end(), 50, p);
  CHECK(enough_for(l, std::vector<PointPlan>(100, plan))[0].samples <= without);
  // The largest allowed number of samples does not bring the rest to the aim, so the sampled points
  // of sources need not be as many.
  plan.error = 0.00025;
  const PointPlan most = enough_for_one(of_errors(100, 0.02, 0.5), plan);
  CHECK(most.samples == 128 * 4096);
  CHECK(most.samples / most.samples_per_direct <= 4096);
}
