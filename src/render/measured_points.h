// Points measured by one integrator: the samples that a plan wants, and what they bring.
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
  bool is_cut_short = false;  // all are measured, but not all is done that was to be

  bool is_complete() const {
    return std::all_of(is_measured.begin(), is_measured.end(), [](uint8_t m) { return m != 0; });
  }
  Counters all_counters() const;
};

// Each place by its plan, or all by one, and once more, by as many samples as that wants, where its
// error is larger than planned; by streams named by the seed and its number. Stops between batches:
// places that were not finished are not measured.
PointValues measure_points(const Integrator& integrator, const std::vector<MeasuringPlace>& places,
                           std::span<const PointPlan> plans, const PointsRun& run);

inline PointValues measure_points(const Integrator& integrator,
                                  const std::vector<MeasuringPlace>& places, const PointPlan& plan,
                                  const PointsRun& run) {
  return measure_points(integrator, places, std::span(&plan, 1), run);
}

// Batches of an integrator that asks for so many shadow rays per sample, so that a stop is soon
// heard.
int samples_per_batch(double rays_per_sample);

// Root mean square of one part's standard errors, relative to all light.
double relative_error(const std::vector<PointLight>& points, Measurement PointLight::*part);

}  // namespace troffer
