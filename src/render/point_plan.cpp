#include "render/point_plan.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace troffer {

namespace {

double aim_of(const PointLight& found, const PointPlan& plan) {
  return plan.error * found.all.illuminance_lx;
}

}  // namespace

bool is_as_planned(const PointLight& found, const PointPlan& plan) {
  const double aim = aim_of(found, plan);
  return !(aim > 0) || found.all.standard_error <= plan.tolerance * aim;
}

PointPlan enough_for(const PointLight& found, PointPlan plan) {
  if (is_as_planned(found, plan)) return plan;
  const double aim = aim_of(found, plan);
  const auto times = [&](double wanted) {
    return std::exp2(std::ceil(std::log2(std::clamp(wanted, 1.0, plan.most_times))));
  };
  if (plan.samples_per_direct <= 1) {
    plan.samples = int(double(plan.samples) * times(sqr(found.all.standard_error / aim)));
    return plan;
  }
  const double seldom = found.seldom_error, often = found.often_error;
  const double of_direct = std::max(seldom * (seldom + often) / sqr(aim), found.least_error / aim);
  const int directs = plan.samples / plan.samples_per_direct * int(times(of_direct));
  plan.samples = std::max(plan.samples * int(times(often * (seldom + often) / sqr(aim))), directs);
  plan.samples_per_direct = plan.samples / directs;
  return plan;
}

}  // namespace troffer
