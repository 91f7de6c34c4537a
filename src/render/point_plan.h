// How many samples the measured points of a list get, and how much of them is light straight from
// sources.
#pragma once

#include <span>
#include <vector>

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
  double shared_error =
      0;                // lx, by what all samples share (RadianceBatch::noise); not in the others
  double kurtosis = 3;  // SampleSets::kurtosis, of `indirect`
  int samples = 0;      // that told it
};

// Lists whose usual samples err by more than this share of the allowed error get more of them.
constexpr double share_of_error = 0.25;
// No point of a list is to err by more than so many times what all of them do.
constexpr double most_of_one_point = 2;

struct PointPlan {
  int samples;
  int samples_per_estimate;
  int samples_per_direct = 1;  // of those, as SensorBatch has it; divides those of a set
  double error = 0;            // relative, that is aimed at; 0: so many samples do
  double tolerance = 1;        // so many times that is well, since samples were chosen for it
  double lx_per_unit = 1;
  // For that, so many times as many samples are taken, at least and at most; of how many is found
  // out by so many times as many, which serve for nothing else where they are fewer than at least.
  double first_times = 1, least_times = 1, most_times = 128;
};

struct SamplesWanted {
  double all = 0;
  double direct = 0;  // of those, with direct light
};

// As many samples of each point as bring the errors of a list down to what its plans, by which
// `found` was measured, aim at. An error counts by the mean of its squares over the point's own
// light and over the list's mean: all points together are to err by no more than the aim, and no
// point by more than about twice that of its own light, so far as samples tell. Of all numbers of
// samples that are enough, these are about the least: n in proportion to the standard deviation of
// a sample times the root of its weight (Neyman's allocation), of either part of the light, as far
// as plans allow, and not fewer than before. All are powers of two times those of the plans. Points
// without light keep their plans. spare: so many samples, of all points, are taken anyway, beside
// something that takes far longer, or as many as bring errors down to what all samples share.
std::vector<SamplesWanted> samples_wanted(std::span<const PointLight> found,
                                          std::span<const PointPlan> plans, double spare = 0);

// The plan by which it is found out how many samples a point wants.
PointPlan first_of(PointPlan plan);

// The plans with as many samples as they want by what was `found` with first_of() them. Where
// direct light takes part in some of the samples alone, of either as many as are wanted.
std::vector<PointPlan> enough_for(std::span<const PointLight> found, std::vector<PointPlan> plans,
                                  double spare = 0);

}  // namespace troffer
