#include "render/point_plan.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace troffer {

namespace {

double error_of(const PointLight& found, const PointPlan& plan) {
  return (plan.is_of_indirect ? found.indirect : found.all).standard_error;
}
double aim_of(const PointLight& found, const PointPlan& plan) {
  return plan.error * found.all.illuminance_lx;
}

}  // namespace

bool is_as_planned(const PointLight& found, const PointPlan& plan) {
  const double aim = aim_of(found, plan);
  return !(aim > 0) || error_of(found, plan) <= aim;
}

PointPlan enough_for(const PointLight& found, PointPlan plan) {
  if (is_as_planned(found, plan)) return plan;
  const double aim = aim_of(found, plan);
  const auto times = [&](double wanted) {
    return std::exp2(std::ceil(std::log2(std::clamp(wanted, 1.0, plan.most_times))));
  };
  if (plan.samples_per_direct <= 1) {
    plan.samples = int(double(plan.samples) * times(sqr(error_of(found, plan) / aim)));
    return plan;
  }
  const double direct = found.direct.standard_error, indirect = found.indirect.standard_error;
  const double of_direct = times(direct * (direct + indirect) / sqr(aim)),
               of_all = std::max(times(indirect * (direct + indirect) / sqr(aim)),
                                 of_direct / plan.samples_per_direct);
  plan.samples = int(double(plan.samples) * of_all);
  // Not more of them: what mirrors bring straight from sources is told as indirect.
  if (of_direct > of_all)
    plan.samples_per_direct = int(double(plan.samples_per_direct) * of_all / of_direct);
  return plan;
}

}  // namespace troffer
