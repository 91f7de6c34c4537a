// Audit of measurements by cells: plain paths at a few points test for bias.
//
// The spread of samples does not show the error of a method's assumptions, such as uniform light
// within a cell. Paths make no such assumption. Where they disagree with the cells, paths replace
// the cells' values or the standard errors grow. Used by measure(); illuminance is in lux.
// Reference: [1] DerSimonian & Laird, "Meta-analysis in clinical trials", Controlled Clinical
//   Trials 7, 1986: moment estimate of the spread of measurements beyond their errors.
#pragma once

#include <optional>
#include <vector>

#include "render/measured_points.h"

namespace troffer {

// Returns the relative bias of `points` against `others`: the root mean square of the differences
// beyond what the standard errors of both explain ([1], Eq. 8, about a known mean of 0). Returns 0
// if the difference is not significant. `normal_quantile` is the normal quantile of the
// significance level; 2.326 stands for one false alarm in a hundred lists.
double relative_bias(const std::vector<Measurement>& points, const std::vector<Measurement>& others,
                     double normal_quantile = 2.326);

// Returns the indices of at most 32 points, one at random from each of equally long parts of the
// list. Regular steps could meet the same few columns in every row of a grid.
std::vector<size_t> audited_points(size_t points);

struct AuditFinding {
  double bias = 0;                  // relative_bias() of indirect light
  bool needed_second_look = false;  // only the second look, with more paths, found the bias
  bool is_worth_paths =
      false;  // the error of points exceeds the asked one, and that of paths would be much less
  // Indices of the audited points, and their indirect light by paths.
  std::vector<size_t> points;
  std::vector<Measurement> by_paths;
};

// Audits points measured by cells under `plan`. `paths` measures a few of them again, with four
// times the plan's samples; it must split direct and indirect light as the cells' integrator does
// (MethodSettings::measures_by_paths). If the difference has a probability under one in ten, a
// second look with sixteen times the samples decides. Returns nothing if it was stopped.
std::optional<AuditFinding> audit(const Integrator& paths,
                                  const std::vector<MeasuringPlace>& places,
                                  const std::vector<PointLight>& by_cells, const PointPlan& plan,
                                  const PointsRun& run);

// Returns the plan for measuring all points by paths, after an audit has rejected the cells.
PointPlan plan_by_paths(PointPlan plan);

// Adds a slight bias to the standard errors of points, which keep their values.
void add_bias_to_errors(double bias, std::vector<PointLight>& by_cells);

// Replaces indirect light by cells, with this relative bias, by that of paths. If the paths'
// standard error is larger, keeps the value and adds the bias to its error instead.
void replace_by_paths(const Measurement& by_paths, double bias, PointLight& by_cells);

// Combines both measurements of audited points if no bias was found: the mean weighted by inverse
// variance. All points share one weight, and at least eight are needed. Individual weights would
// correlate with the values and favour sums that are small by chance.
void combine_measurements(const AuditFinding& finding, std::vector<PointLight>& by_cells);

}  // namespace troffer
