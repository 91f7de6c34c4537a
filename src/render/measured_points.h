// Measurement of a list of points by one integrator: samples by plan, a second round where the
// error needs it, and standard errors from independent sets. Used by measure(), its audit and its
// forecast. Illuminance is in lux.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "render/measuring_places.h"
#include "render/point_plan.h"
#include "transport/integrator.h"

namespace troffer {

struct PointsRun {
  uint64_t seed = 0;
  int threads = 0;
  int samples_per_batch = 0;
  ProgressCallback progress;  // may be empty
  const StopFlag& stop;
  double spare_samples = 0;  // samples_wanted()
};

struct PointValues {
  std::vector<PointLight> values;
  std::vector<uint8_t> is_measured;
  std::vector<Counters> counters;
  bool is_cut_short = false;  // all points are measured, but a later step was skipped by a stop

  bool is_complete() const {
    return std::all_of(is_measured.begin(), is_measured.end(), [](uint8_t m) { return m != 0; });
  }
  Counters all_counters() const;
};

// Measures each place by its plan, or all by a single one. A second round measures places whose
// error is too large with as many samples as they need. Random streams derive from the seed and the
// index of the place. Stops between batches; unfinished places do not count as measured.
PointValues measure_points(const Integrator& integrator, const std::vector<MeasuringPlace>& places,
                           std::span<const PointPlan> plans, const PointsRun& run);

inline PointValues measure_points(const Integrator& integrator,
                                  const std::vector<MeasuringPlace>& places, const PointPlan& plan,
                                  const PointsRun& run) {
  return measure_points(integrator, places, std::span(&plan, 1), run);
}

// Returns the batch size for an integrator with this many shadow rays per sample, small enough for
// a quick response to stops.
int samples_per_batch(double rays_per_sample);

// Returns the root mean square of one part's standard errors, relative to all light.
double relative_error(const std::vector<PointLight>& points, Measurement PointLight::*part);

}  // namespace troffer
