// Whether measurements may be trusted as far as they say.
//
// What a method takes on trust (that light is even across a cell) no spread of its own samples
// tells. A few paths, which trust nothing, do; where they say otherwise, more paths take its place.
// Reference: [1] DerSimonian & Laird, "Meta-analysis in clinical trials", Controlled Clinical
//   Trials 7, 1986: the moments' estimate of what spreads measurements beyond their errors.
#pragma once

#include <optional>
#include <vector>

#include "render/measured_points.h"

namespace troffer {

// By how much, relative to their light, points differ from what others say of the same points
// beyond what the standard errors of both let expect: [1], Eq. 8, about a mean that is known, 0;
// root mean square. 0 where chance alone would let them differ by as much more often than in one of
// so many lists: `normal_quantile` is that of 1 less that share (2.326: one of a hundred).
double relative_bias(const std::vector<Measurement>& points, const std::vector<Measurement>& others,
                     double normal_quantile = 2.326);

// Numbers of points of a list, evenly spread over it: few, so that a long list takes little longer.
// Not at even steps, for lists are often grids: those might meet the same few columns in every row.
std::vector<size_t> few_of(size_t points);

struct AuditFinding {
  double bias = 0;         // relative_bias() of light that was reflected before
  bool is_slight = false;  // the bias: only so many more paths have found it
  bool is_worth_paths =
      false;  // points err by more than is asked for, and paths would by much less
  // That light by paths, and whose it is.
  std::vector<size_t> points;
  std::vector<Measurement> by_paths;
};

// Of points that were measured by cells, beside few of them by `paths` (light straight from sources
// as theirs, MethodSettings::measures_by_paths), each with four times the plan's samples; and where
// these say otherwise as they would by chance in one list of ten, by others, with sixteen times,
// which decide. plan: theirs. Empty where a stop came before.
std::optional<AuditFinding> audit(const Integrator& paths,
                                  const std::vector<MeasuringPlace>& places,
                                  const std::vector<PointLight>& by_cells, const PointPlan& plan,
                                  const PointsRun& run);

// How all points are measured by paths where those of `plan` are not good enough.
PointPlan plan_by_paths(PointPlan plan);

// Where the bias is slight, points keep it, and are told it.
void tell_bias(double bias, std::vector<PointLight>& by_cells);

// Light that was reflected before by paths in place of that by cells, which is biased by about so
// much of it; but not where paths err by more.
void take_better(const Measurement& by_paths, double bias, PointLight& by_cells);

// Where nothing is found wrong, points have been measured twice: those that were audited become the
// mean of both, weighted by what errs less. By one weight for all of them, and of several: weights
// of their own would prefer sums that are small by chance, as their errors are then.
void take_both(const AuditFinding& finding, std::vector<PointLight>& by_cells);

}  // namespace troffer
