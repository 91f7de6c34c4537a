#include "render/points_forecast.h"

#include <algorithm>
#include <limits>

#include "base/units.h"
#include "render/audit.h"

namespace troffer {

namespace {

// Per point of the look; enough for an estimate of its noise.
constexpr int samples_looked_at = 1024;
// Sample counts come from a short look, so points are measured again only if it was misleading.
constexpr double tolerance = 1.5;
// Least cost of a point by cells without its audit, in rays of paths; approximate.
constexpr double rays_of_point = 4e4;
// Cost of making cells in an unknown scene, in rays. Measured in four rooms and halls: 3 to 20
// million, or 180 to 360 per cell (rays_of_made_cell).
constexpr double rays_of_cells = 7e6;

// Returns the sample counts that the aim needs without a limit.
std::vector<double> samples_at_will(const std::vector<PointLight>& found,
                                    std::vector<PointPlan> plans) {
  constexpr double at_will = 0x1p40;
  for (PointPlan& p : plans) p.most_times = at_will;
  const std::vector<SamplesWanted> wanted = samples_wanted(found, plans);
  std::vector<double> samples;
  for (size_t i = 0; i < found.size(); ++i)
    // If none of the few samples found light, no number of samples can be promised to be enough.
    samples.push_back(found[i].all.illuminance_lx > 0 ? wanted[i].all
                                                      : std::numeric_limits<double>::infinity());
  return samples;
}

}  // namespace

bool PointsForecast::is_for_paths() const {
  return rays_for_cells < rays_of_cells;
}

double PointsForecast::most_cells() const {
  return rays_for_cells / rays_of_made_cell;
}

std::optional<PointsForecast> forecast_points(const Integrator& paths,
                                              const std::vector<MeasuringPlace>& places,
                                              const PointPlan& plan, const PointsRun& run) {
  std::vector<MeasuringPlace> at;
  for (const size_t i : audited_points(places.size())) at.push_back(places[i]);
  PointPlan look = plan;
  look.samples = std::min(plan.samples, samples_looked_at);
  look.samples_per_direct =
      // the same number with direct light
      std::max(plan.samples_per_direct * look.samples / plan.samples, 1);
  look.error = 0;
  const PointValues few = measure_points(paths, at, look, run);
  if (!few.is_complete()) return std::nullopt;
  look.error = plan.error;
  look.most_times = plan.most_times * plan.samples / look.samples;
  const std::vector<PointPlan> looks(few.values.size(), look),
      enough_for_all = enough_for(few.values, looks);
  const std::vector<double> at_will = samples_at_will(few.values, looks);
  PointsForecast f;
  for (size_t i = 0; i < few.values.size(); ++i) {
    const PointPlan& enough = enough_for_all[i];
    PointPlan& own = f.plans.emplace_back(plan);
    own.samples = std::max(enough.samples, plan.samples);
    own.samples_per_direct = own.samples / (enough.samples / enough.samples_per_direct);
    own.most_times = std::max(plan.most_times * plan.samples / own.samples, 1.0);
    own.tolerance = tolerance;
    f.samples += std::max(at_will[i], double(own.samples)) / double(few.values.size());
  }
  const double samples = double(look.samples) * double(few.values.size());
  // one ray to the next surface and one from there to a light
  const double rays_of_sample = 2 * double(few.all_counters().extension_rays) / samples;
  const auto points = double(places.size());
  f.rays = rays_of_sample * f.samples * points;
  // The audit takes as many paths per point as a plan by paths begins with.
  f.rays_of_audit = rays_of_sample * plan.samples * double(at.size());
  f.rays_for_cells = f.rays - rays_of_point * points - f.rays_of_audit;
  return f;
}

}  // namespace troffer
