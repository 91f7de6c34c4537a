#include "render/audit.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/units.h"
#include "render/sample_sets.h"

namespace troffer {

namespace {

// Paths per sample of an audited point, and the largest further factor if all points are measured
// by paths.
constexpr int paths_of_sample = 4;
constexpr double most_times_audit = 16;
constexpr double much_more = 2;  // factor by which one error must exceed another
// If the first look finds a difference that chance alone would give in one list of ten (this
// quantile of the normal distribution), a second look follows with `times_in_doubt` times as many
// paths. Few paths may all miss a bright caustic that the cells contain, and then underestimate
// their own error.
constexpr double quantile_of_doubt = 1.2816;
constexpr int times_in_doubt = 4;

// True if points by cells miss the error asked for, and the largest allowed number of paths would
// do much better. `few` holds the values by the audit's paths.
bool are_worth_paths(const std::vector<PointLight>& by_cells, const std::vector<PointLight>& few,
                     double aim) {
  const double told = relative_error(by_cells, &PointLight::all);
  const double by_paths = relative_error(few, &PointLight::indirect) / std::sqrt(most_times_audit);
  return aim > 0 && told > aim / share_of_error && told > much_more * by_paths;
}

// Direct light is already known, so only one sample of each set includes it.
PointPlan audit_plan(const PointPlan& plan, int times = 1) {
  PointPlan p{.samples = plan.samples * paths_of_sample * times,
              .samples_per_estimate = 1,
              .lx_per_unit = plan.lx_per_unit};
  p.samples_per_direct = (p.samples + most_sets - 1) / most_sets;
  return p;
}

}  // namespace

double relative_bias(const std::vector<Measurement>& points, const std::vector<Measurement>& others,
                     double normal_quantile) {
  double squares = 0, weights = 0, count = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const double e = points[i].illuminance_lx;
    const double variance = sqr(points[i].standard_error) + sqr(others[i].standard_error);
    if (!(e > 0) || !(others[i].standard_error > 0)) continue;
    squares += sqr(others[i].illuminance_lx - e) / variance;
    weights += sqr(e) / variance;
    count += 1;
  }
  if (count == 0) return 0;
  // The quantile of chi-squared, by Wilson and Hilferty.
  const double part = 2 / (9 * count), root = 1 - part + normal_quantile * std::sqrt(part);
  if (squares <= count * root * root * root) return 0;
  return std::sqrt((squares - count) / weights);
}

std::vector<size_t> audited_points(size_t points) {
  constexpr size_t most = 32;
  const size_t few = std::min(points, most);
  std::vector<size_t> which;
  for (size_t k = 0; k < few; ++k) {
    const size_t first = k * points / few, end = (k + 1) * points / few;
    which.push_back(first + size_t(hash_of(uint64_t{k}) % (end - first)));
  }
  return which;
}

std::optional<AuditFinding> audit(const Integrator& paths,
                                  const std::vector<MeasuringPlace>& places,
                                  const std::vector<PointLight>& by_cells, const PointPlan& plan,
                                  const PointsRun& run) {
  AuditFinding f;
  f.points = audited_points(places.size());
  std::vector<MeasuringPlace> at;
  std::vector<Measurement> of_cells;
  for (const size_t i : f.points) {
    at.push_back(places[i]);
    of_cells.push_back(by_cells[i].indirect);
  }
  PointsRun round = run;
  bool is_doubted = false;  // the first look found a bias
  for (const bool is_last : {false, true}) {
    PointValues few =
        measure_points(paths, at, audit_plan(plan, is_last ? times_in_doubt : 1), round);
    if (!few.is_complete()) return std::nullopt;
    f.by_paths.clear();
    for (size_t k = 0; k < at.size(); ++k) {
      f.by_paths.push_back(few.values[k].indirect);
      few.values[k].all = by_cells[f.points[k]].all;
    }
    f.bias = relative_bias(of_cells, f.by_paths);
    f.needed_second_look = is_last && !is_doubted;
    if (!is_last) f.is_worth_paths = are_worth_paths(by_cells, few.values, plan.error);
    is_doubted = f.bias > 0;
    // Points that paths will replace anyway need no second look.
    if (f.is_worth_paths || relative_bias(of_cells, f.by_paths, quantile_of_doubt) == 0) break;
    round.seed = hash_of(run.seed, 1u);
  }
  return f;
}

PointPlan plan_by_paths(PointPlan plan) {
  if (!(plan.error > 0)) return audit_plan(plan);
  plan.samples *= paths_of_sample;
  plan.samples_per_direct *= paths_of_sample;
  plan.first_times = plan.least_times = 1;
  plan.most_times = most_times_audit;
  return plan;
}

void add_bias_to_errors(double bias, std::vector<PointLight>& by_cells) {
  for (PointLight& v : by_cells)
    v.all.standard_error = std::hypot(v.all.standard_error, bias * v.indirect.illuminance_lx);
}

void replace_by_paths(const Measurement& by_paths, double bias, PointLight& v) {
  const double more = bias * v.indirect.illuminance_lx;
  if (by_paths.standard_error >= std::hypot(v.indirect.standard_error, more)) {
    v.all.standard_error = std::hypot(v.all.standard_error, more);
    return;
  }
  v.all = {v.direct.irradiance + by_paths.irradiance,
           v.direct.illuminance_lx + by_paths.illuminance_lx,
           std::hypot(v.direct.standard_error, by_paths.standard_error)};
}

void combine_measurements(const AuditFinding& finding, std::vector<PointLight>& by_cells) {
  constexpr size_t several = 8;
  if (finding.points.size() < several) return;
  double of_cells = 0, of_paths = 0;  // variances relative to all light
  for (size_t k = 0; k < finding.points.size(); ++k) {
    const PointLight& v = by_cells[finding.points[k]];
    if (!(v.all.illuminance_lx > 0)) continue;
    of_cells += sqr(v.indirect.standard_error / v.all.illuminance_lx);
    of_paths += sqr(finding.by_paths[k].standard_error / v.all.illuminance_lx);
  }
  if (!(of_cells > 0) || !(of_paths > 0)) return;
  const double weight = of_cells / (of_cells + of_paths);
  for (size_t k = 0; k < finding.points.size(); ++k) {
    PointLight& v = by_cells[finding.points[k]];
    const Measurement &cells = v.indirect, &paths = finding.by_paths[k];
    Measurement both = cells;
    both.standard_error =
        std::hypot((1 - weight) * cells.standard_error, weight * paths.standard_error);
    both.irradiance += (paths.irradiance - cells.irradiance) * float(weight);
    both.illuminance_lx += (paths.illuminance_lx - cells.illuminance_lx) * weight;
    v.all.irradiance += both.irradiance - cells.irradiance;
    v.all.illuminance_lx += both.illuminance_lx - cells.illuminance_lx;
    v.all.standard_error =
        std::sqrt(std::max(sqr(v.all.standard_error) - sqr(cells.standard_error), 0.0) +
                  sqr(both.standard_error));
    v.indirect = both;
  }
}

}  // namespace troffer
