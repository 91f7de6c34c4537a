// How many samples a measured point gets for its error.
#include "render/point_plan.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace troffer;

namespace {

PointLight of_errors(double lx, double direct, double indirect) {
  PointLight p;
  p.all = {Rgb{}, lx, std::hypot(direct, indirect)};
  p.direct = {Rgb{}, lx / 2, direct};
  p.indirect = {Rgb{}, lx / 2, indirect};
  p.seldom_error = direct;
  p.often_error = indirect;
  return p;
}

// By the plan's samples, which were those of `before`.
double error_expected(const PointLight& found, const PointPlan& before, const PointPlan& plan) {
  const double all = double(plan.samples) / before.samples;
  const double of_direct = all * before.samples_per_direct / plan.samples_per_direct;
  return std::hypot(found.direct.standard_error / std::sqrt(of_direct),
                    found.indirect.standard_error / std::sqrt(all));
}

}  // namespace

TEST_CASE("a point that errs by no more than planned keeps its plan") {
  PointPlan plan{4096, 1, 32, 0.0025};
  for (const PointLight& p : {of_errors(100, 0.1, 0.2), of_errors(0, 1, 1)}) {
    CHECK(is_as_planned(p, plan));
    CHECK(enough_for(p, plan).samples == 4096);
    CHECK(enough_for(p, plan).samples_per_direct == 32);
  }
  plan.tolerance = 2;
  CHECK(is_as_planned(of_errors(100, 0.2, 0.4), plan));
  CHECK_FALSE(is_as_planned(of_errors(100, 0.3, 0.5), plan));
  plan.error = 0;  // so many samples do
  CHECK(is_as_planned(of_errors(100, 50, 50), plan));
}

TEST_CASE("plans bring the error down to what is aimed at, by more of what errs") {
  const PointPlan before{4096, 1, 32, 0.0025};
  for (const double direct : {0.0, 0.01, 0.1, 0.5, 1.0, 2.0})
    for (const double indirect : {0.0, 0.01, 0.1, 0.5, 1.0, 2.0}) {
      const PointLight found = of_errors(100, direct, indirect);
      if (is_as_planned(found, before)) continue;
      const PointPlan plan = enough_for(found, before);
      CAPTURE(direct);
      CAPTURE(indirect);
      CAPTURE(plan.samples);
      CAPTURE(plan.samples_per_direct);
      CHECK(error_expected(found, before, plan) <= 0.25 * 1.0001);
      CHECK(plan.samples_per_direct >= 1);
      // Whole sets of 32, with direct light in each.
      CHECK(plan.samples % (32 * plan.samples_per_direct) == 0);
      // Not much more than is needed: both parts are rounded up to powers of two.
      const double least = (direct + indirect) * (direct + indirect) / (0.25 * 0.25);
      const double work = double(plan.samples) / before.samples *
                          (1 + double(before.samples_per_direct) / plan.samples_per_direct);
      CHECK(work <= 4 * (least + 2));
    }
  // Where direct light alone errs, other samples stay few.
  CHECK(enough_for(of_errors(100, 0.9, 0.001), before).samples == 4096);
  CHECK(enough_for(of_errors(100, 0.9, 0.001), before).samples_per_direct == 2);
  CHECK(enough_for(of_errors(100, 0.001, 0.9), before).samples == 16 * 4096);
  CHECK(enough_for(of_errors(100, 0.001, 0.9), before).samples_per_direct == 16 * 32);
}

TEST_CASE("no plan takes more than its most, and one kind of samples grows by itself") {
  PointPlan plan{4096, 1, 32, 0.0025};
  plan.most_times = 128;
  CHECK(enough_for(of_errors(100, 0, 1000), plan).samples == 128 * 4096);
  const PointPlan both = enough_for(of_errors(100, 1000, 0), plan);
  CHECK(both.samples / both.samples_per_direct == 128 * (4096 / 32));
  plan.samples_per_direct = 1;
  CHECK(enough_for(of_errors(100, 0.3, 0.4), plan).samples == 4 * 4096);
}
