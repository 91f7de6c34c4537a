#include "render/point_plan.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/units.h"

namespace troffer {

namespace {

// One of the two parts of a point's light. Errors are weighted by the root of the point's weight
// and divided by the aim, so that the mean square over all points should be 1.
struct Part {
  double error = 0;  // standard error, falls with the root of the sample count
  double least = 0;  // least error, falls with the sample count; each point must meet it by itself
  double samples = 0, most_times = 1;
  double times = 1;  // least factor on the sample count

  double variance(double t) const { return sqr(error) / t; }
  // Returns the factor on the sample count at a given scale (a logarithm), as a power of two.
  double times_by(double log_of_scale) const {
    if (!(error > 0)) return times;
    const double wanted = std::round(log_of_scale + std::log2(error / std::sqrt(samples)));
    return std::clamp(std::exp2(std::min(wanted, 64.0)), times, most_times);
  }
};

struct PlannedPoint {
  Part often, seldom;  // error of `seldom` is 0 if all samples include direct light
  double variance_of_most = 0, shared_variance = 0;
};

double times_up(double wanted, double most) {
  return std::min(std::exp2(std::ceil(std::log2(std::clamp(wanted, 1.0, most)))), most);
}

bool is_for_more(const PointLight& found, const PointPlan& plan) {
  return plan.error > 0 && found.all.illuminance_lx > 0 &&
         std::isfinite(found.all.standard_error) && found.all.standard_error > 0;
}

// Sets the factors that this point needs by itself, whatever the others are.
void ask_for_least(const PointLight& found, const PointPlan& plan, double lx, PlannedPoint& p) {
  const double own = plan.error * found.all.illuminance_lx / lx, aim = most_of_one_point * own;
  Part &often = p.often, &seldom = p.seldom;
  if (seldom.least > plan.tolerance * own)
    seldom.times = times_up(seldom.least / own, seldom.most_times);
  const double both = often.error + seldom.error;
  if (sqr(often.error) + sqr(seldom.error) <= sqr(plan.tolerance * aim)) return;
  often.times = times_up(often.error * both / sqr(aim), often.most_times);
  seldom.times =
      std::max(seldom.times, times_up(seldom.error * both / sqr(aim), seldom.most_times));
}

PlannedPoint planned(const PointLight& found, const PointPlan& plan, double mean_lx) {
  const double own_lx = found.all.illuminance_lx;
  // lux that count as 1
  const double lx = plan.error / std::sqrt(0.5 / sqr(own_lx) + 0.5 / sqr(mean_lx));
  PlannedPoint p;
  p.often.samples = plan.samples;
  p.seldom.samples = double(plan.samples) / plan.samples_per_direct;
  for (Part* part : {&p.often, &p.seldom}) part->most_times = std::max(plan.most_times, 1.0);
  if (plan.samples_per_direct > 1) {
    p.often.error = found.other_part_error / lx;
    p.seldom.error = found.direct_part_error / lx;
    p.seldom.least = found.least_error / lx;
  } else {
    p.often.error = found.all.standard_error / lx;
  }
  p.shared_variance = sqr(found.shared_error / lx);
  ask_for_least(found, plan, lx, p);
  for (const Part* part : {&p.often, &p.seldom})
    p.variance_of_most += part->variance(part->most_times);
  return p;
}

// Logarithms of scales; the scale fixes the sample counts of all points.
constexpr double least_of_scale = -100;
// Returns the variance that remains with the largest allowed sample count, plus a margin. Without
// the margin, parts of little error would get as many samples as noisy ones.
double nearly_most(const PlannedPoint& p) {
  return p.variance_of_most + 0.1 * std::min(p.variance_of_most, 1.0);
}

class PlannedList {
 public:
  void add(const PlannedPoint& p) { points_.push_back(p); }
  const std::vector<PlannedPoint>& points() const { return points_; }

  // Returns the allowed sum of variances, or what is reachable if sample counts are limited.
  double variance_allowed(double of_point) const {
    double sum = 0;
    for (const PlannedPoint& p : points_) sum += std::max(of_point, nearly_most(p));
    return sum;
  }
  // Returns the least scale at which the variance is within `allowed`.
  double scale_for(double allowed) const {
    return least_scale([&](double scale) { return variance(scale) <= allowed; });
  }
  // Returns the scale at which the points take `samples_in_all` samples together. It is smaller if
  // the variance already falls to the part that more samples cannot reduce.
  double scale_by(double samples_in_all) const {
    double shared = 0;
    for (const PlannedPoint& p : points_) shared += std::max(p.shared_variance, nearly_most(p));
    return least_scale([&](double scale) {
      return samples(scale) >= samples_in_all || variance(scale) <= shared;
    });
  }
  double variance(double log_of_scale) const {
    double sum = 0;
    for (const PlannedPoint& p : points_)
      for (const Part* part : {&p.often, &p.seldom})
        sum += part->variance(part->times_by(log_of_scale));
    return sum;
  }

 private:
  double samples(double log_of_scale) const {
    double sum = 0;
    for (const PlannedPoint& p : points_)
      for (const Part* part : {&p.often, &p.seldom})
        sum += part->samples * part->times_by(log_of_scale);
    return sum;
  }
  // Returns the least scale that fulfils a monotonic condition.
  template <typename Condition>
  static double least_scale(const Condition& holds) {
    double low = least_of_scale, high = -least_of_scale;
    while (high - low > 1e-3) {
      const double middle = 0.5 * (low + high);
      (holds(middle) ? high : low) = middle;
    }
    return high;
  }

  std::vector<PlannedPoint> points_;
};

double mean_light(std::span<const PointLight> points) {
  double sum = 0;
  int lit = 0;
  for (const PointLight& p : points) {
    if (!(p.all.illuminance_lx > 0) || !std::isfinite(p.all.illuminance_lx)) continue;
    sum += p.all.illuminance_lx;
    ++lit;
  }
  return lit > 0 ? sum / lit : 0;
}

}  // namespace

std::vector<SamplesWanted> samples_wanted(std::span<const PointLight> found,
                                          std::span<const PointPlan> plans, double spare) {
  TROFFER_CHECK(found.size() == plans.size());
  const double mean = mean_light(found);
  std::vector<SamplesWanted> wanted;
  std::vector<size_t> which;
  PlannedList list;
  double tolerance = 1;
  for (size_t i = 0; i < found.size(); ++i) {
    const PointPlan& plan = plans[i];
    wanted.push_back({double(plan.samples), double(plan.samples) / plan.samples_per_direct});
    if (!is_for_more(found[i], plan)) continue;
    which.push_back(i);
    list.add(planned(found[i], plan, mean));
    tolerance = std::max(tolerance, plan.tolerance);
  }
  const bool is_well = list.variance(least_of_scale) <= list.variance_allowed(sqr(tolerance));
  double scale = is_well ? least_of_scale : list.scale_for(list.variance_allowed(1));
  if (spare > 0) scale = std::max(scale, list.scale_by(spare));
  for (size_t k = 0; k < which.size(); ++k) {
    const PlannedPoint& p = list.points()[k];
    const PointPlan& plan = plans[which[k]];
    SamplesWanted& w = wanted[which[k]];
    w.all *= p.often.times_by(scale);
    w.direct *= (plan.samples_per_direct > 1 ? p.seldom : p.often).times_by(scale);
  }
  return wanted;
}

PointPlan first_of(PointPlan plan) {
  if (!(plan.error > 0)) return plan;
  const double times = plan.first_times;
  plan.samples = int(plan.samples * times);
  plan.samples_per_direct = std::max(int(plan.samples_per_direct * times), 1);
  plan.most_times /= times;
  return plan;
}

std::vector<PointPlan> enough_for(std::span<const PointLight> found, std::vector<PointPlan> plans,
                                  double spare) {
  std::vector<PointPlan> first;
  for (const PointPlan& p : plans) first.push_back(first_of(p));
  const std::vector<SamplesWanted> wanted = samples_wanted(found, first, spare);
  for (size_t i = 0; i < plans.size(); ++i) {
    PointPlan& p = plans[i];
    if (!(p.error > 0)) continue;
    const double directs = std::max(wanted[i].direct, double(p.samples / p.samples_per_direct));
    p.samples = int(std::max({wanted[i].all, directs, p.samples * p.least_times}));
    if (p.samples_per_direct > 1) p.samples_per_direct = int(p.samples / directs);
  }
  return plans;
}

}  // namespace troffer
