// Allocation of samples to the measuring points of a list, and to direct light within them. Used by
// measure_points() and the forecast. Errors are standard errors in lux, aims are relative.
#pragma once

#include <span>
#include <vector>

#include "render/measure.h"

namespace troffer {

// Measured light of a point: all of it, direct light, and indirect light. The parts may be
// correlated, so errors need not add in quadrature.
struct PointLight {
  Measurement all, direct, indirect;
  // Standard errors, lx. seldom: light that only every samples_per_direct-th sample includes, which
  // is direct light and its mirror images. often: all other light.
  double direct_part_error = 0, other_part_error = 0;
  // least error of `direct` with sampled points on sources, lx; falls with the sample count
  double least_error = 0;
  double shared_error =
      // error that all samples share (RadianceBatch::noise), lx; not part of the others
      0;
  double kurtosis = 3;  // SampleSets::kurtosis of `indirect`
  int samples = 0;      // number of samples behind these values
};

// A list whose usual samples err by more than this share of the error asked for gets more.
constexpr double share_of_error = 0.25;
// Largest error of one point of a list, as a multiple of the list's aim.
constexpr double most_of_one_point = 2;

struct PointPlan {
  int samples;
  int samples_per_estimate;
  int samples_per_direct = 1;  // every so many-th sample includes direct light (SensorBatch)
  double error = 0;            // relative error aimed at; 0: exactly `samples` samples
  // factor on `error` that is accepted, since the samples were chosen for it
  double tolerance = 1;
  double lx_per_unit = 1;
  // Factors on `samples`: for the first look, and the least and the most for the result. If the
  // first look has fewer samples than the least, it only determines the sample count.
  double first_times = 1, least_times = 1, most_times = 128;
};

struct SamplesWanted {
  double all = 0;
  double direct = 0;  // number of those that include direct light
};

// Returns the sample counts with which a list meets the aim of its plans; `found` holds its values
// by these plans. Half of a point's weight is relative to its own light, half relative to the
// list's mean. The root mean square over all points must not exceed the aim, nor a point about
// twice the aim at its own light.
//
// Among such counts these are about the least: n is proportional to the standard deviation of a
// sample times the root of its weight (Neyman allocation). This holds per part of the light and
// within the limits of the plans. All counts are a plan's times a power of two, at least 1. Points
// without light keep their plans.
//
// spare: number of samples over all points that cost little compared to other work and are taken
// anyway. They are limited to what brings errors down to those that all samples share.
std::vector<SamplesWanted> samples_wanted(std::span<const PointLight> found,
                                          std::span<const PointPlan> plans, double spare = 0);

// Returns the plan of the first look, which determines how many samples a point needs.
PointPlan first_of(PointPlan plan);

// Returns the plans with the sample counts that `found`, measured by first_of() of them, asks for.
// The number of samples with direct light is chosen separately.
std::vector<PointPlan> enough_for(std::span<const PointLight> found, std::vector<PointPlan> plans,
                                  double spare = 0);

}  // namespace troffer
