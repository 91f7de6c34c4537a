// How many samples a measured point gets, and how much of them is light straight from sources.
#pragma once

#include "render/measure.h"

namespace troffer {

// Light straight from sources, the rest, and both together, whose error is less than their errors'
// sum where these have to do with each other.
struct PointLight {
  Measurement all, direct, indirect;
  // Standard errors, lx, of what takes part in every so many-th sample alone (`direct`, and what
  // mirrors bring of it), and of the rest.
  double seldom_error = 0, often_error = 0;
  double least_error = 0;  // of `direct`, lx, by points drawn of sources: falls as samples grow
  double kurtosis = 3;     // SampleSets::kurtosis, of `indirect`
  int samples = 0;         // that told it
};

// Points whose usual samples err by more than this share of the allowed error get more of them.
constexpr double share_of_error = 0.25;

struct PointPlan {
  int samples;
  int samples_per_estimate;
  int samples_per_direct = 1;  // of those, as SensorBatch has it; divides those of a set
  double error = 0;            // relative, that is aimed at; 0: so many samples do
  double tolerance = 1;        // so many times that is well, since samples were chosen for it
  double lx_per_unit = 1;
  double most_times = 128;  // so many times as many samples are taken for that, at most
};

// Whether a point that was measured by the plan errs by no more than it has it.
bool is_as_planned(const PointLight& found, const PointPlan& plan);

// As many samples as bring the error of a point that was measured by the plan down to that. Where
// direct light takes part in some of the samples alone, of either as many as take the least time
// together: both parts' samples are taken to cost the same by now, so that each is to be taken in
// proportion to its error (Neyman's allocation), but neither are fewer than before. Numbers of
// samples grow by powers of two.
PointPlan enough_for(const PointLight& found, PointPlan plan);

}  // namespace troffer
