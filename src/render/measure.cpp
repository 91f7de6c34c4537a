#include "render/measure.h"

#include <cmath>
#include <memory>
#include <optional>

#include "base/random.h"
#include "base/streams.h"
#include "base/units.h"
#include "render/audit.h"
#include "render/measured_points.h"
#include "render/measuring_places.h"
#include "render/point_plan.h"
#include "render/points_forecast.h"
#include "render/sample_sets.h"

namespace troffer {

namespace {

// Cost of one gathered sample of a measuring point, in path-traced rays; approximate.
constexpr double rays_of_sample = 4;

// Purposes of random streams besides the points' own.
enum class Round : uint64_t { audit = 0, by_paths = 1, forecast = 2 };

// Adds errors that all samples share, which their spread does not show. The factor of Student's t
// accounts for the small number of draws.
void add_shared_errors(std::vector<PointLight>& values) {
  const double of_draws = t_quantile_95(draws_of_noise) / 1.959964;
  for (PointLight& v : values)
    for (Measurement* m : {&v.all, &v.indirect})
      m->standard_error = std::hypot(m->standard_error, v.shared_error * of_draws);
}

MeasureResult nothing_measured(size_t points) {
  MeasureResult result;
  result.values.resize(points);
  result.is_measured.assign(points, false);
  result.is_complete = false;
  return result;
}

std::vector<size_t> in_others(const std::vector<MeasuringPlace>& places) {
  std::vector<size_t> which;
  for (size_t i = 0; i < places.size(); ++i)
    if (places[i].is_in_other) which.push_back(i);
  return which;
}

CellPilot points_pilot(const std::vector<MeasuringPlace>& places) {
  CellPilot pilot;
  for (const MeasuringPlace& p : places)
    pilot.places.push_back({p.position, p.normal, p.normal, p.offset});
  return pilot;
}

MethodSettings settings_of(const MeasureOptions& options) {
  MethodSettings settings;
  settings.indirect = options.indirect;
  settings.shadow_rays = options.method.row().rays_of_measuring_sample;
  settings.error = options.error;
  settings.viewing_rays = options.spp > 0 ? options.spp : default_samples(options.method);
  settings.trees = options.kj92.sampling;
  settings.depth = options.method == Method::path ? options.depth : -1;
  settings.threads = options.threads;
  return settings;
}

PointPlan plan_of(const MeasureOptions& options, const Scene& scene) {
  const MethodRow& row = options.method.row();
  PointPlan plan{.samples = options.spp > 0 ? options.spp : default_samples(options.method),
                 .samples_per_estimate = row.rays_of_measuring_sample,
                 .lx_per_unit = scene.is_photometric ? 1.0 : luminous_efficacy};
  if (row.measures_to_error && options.spp == 0) {
    plan.error = share_of_error * options.error;
    plan.samples_per_direct = row.measuring_samples_per_direct;
    plan.first_times = 0.5;
    plan.least_times = 2;
  }
  return plan;
}

GatheringPoints gathering_by(const PointPlan& plan) {
  const double most_times = plan.error > 0 ? plan.most_times : 1;
  return {plan.samples * plan.least_times, plan.samples * most_times, plan.error};
}

// Measures a list of points by the method, or by paths where that is better.
class PointsMeasuring {
 public:
  PointsMeasuring(const PreparedScene& scene, const std::vector<MeasuringPlace>& places,
                  const MeasureOptions& options, const Preparation* preparation,
                  const ProgressCallback& progress, const StopFlag& stop)
      : scene_(scene),
        places_(places),
        options_(options),
        preparation_(preparation),
        settings_(settings_of(options)),
        plan_(plan_of(options, scene.scene)),
        samples_of_batch_(samples_per_batch(
            options.method.row().rays_per_sample(settings_, scene.scene.lights.size()))),
        progress_(progress),
        stop_(stop) {}

  // Returns nothing, or incomplete values, after a stop.
  PointValues values() {
    if (!needs_cells(options_.method, options_.indirect)) return measured_by_method(nullptr);
    CellInput cells{points_pilot(places_), nullptr, options_.seed, nullptr, stop_, {}, {},
                    options_.cells};
    cells.points = gathering_by(plan_);
    if (may_choose()) {
      const auto forecast =
          forecast_points(by_paths(), places_, plans_[0], run_of(Round::forecast));
      if (!forecast) return {};
      if (forecast->plans.size() == places_.size()) plans_ = forecast->plans;
      if (forecast->is_for_paths()) return measured_by_paths(progress_);
      cells.most_cells = forecast->most_cells();
      cells.points.other_rays = rays_of_audit_ = forecast->rays_of_audit;
    }
    PointValues found = measured_by_method(&cells);
    if (stop_.load()) {
      found.is_cut_short = true;
      return found;
    }
    if (found.values.size() < places_.size()) return measured_by_paths(progress_);
    check(found);
    return found;
  }

 private:
  // True unless the caller asks for cells or wants them kept.
  bool may_choose() const {
    return options_.spp == 0 && options_.cells == nullptr &&
           options_.indirect == Indirect::automatic && !places_.empty() &&
           !scene_.scene.lights.empty();
  }
  PointsRun run_of(Round round) const {
    return {hash_of(options_.seed, uint64_t(round), stream::measuring_rounds), options_.threads,
            samples_of_batch_, nullptr, stop_};
  }
  // Returns the integrator with the method's direct light and path-traced indirect light. Paths
  // that end at cells become whole paths.
  const Integrator& by_paths() {
    MethodSettings settings = settings_;
    settings.measures_by_paths = true;
    const Method method = options_.method == Method::cached_path ? Method::path : options_.method;
    if (!by_paths_) by_paths_ = make_integrator(scene_, method, settings, preparation_, nullptr);
    return *by_paths_;
  }
  PointValues measured_by_method(CellInput* cells) {
    const std::unique_ptr<Integrator> integrator =
        make_integrator(scene_, options_.method, settings_, preparation_, cells);
    if (!integrator) return {};
    double spare_rays = rays_of_audit_;
    if (cells != nullptr && options_.cells == nullptr)
      spare_rays += rays_of_made_cell * double(cells->statistics.cells);
    PointValues found = measure_points(*integrator, places_, plan_,
                                       {options_.seed, options_.threads, samples_of_batch_,
                                        progress_, stop_, spare_rays / rays_of_sample});
    add_shared_errors(found.values);
    return found;
  }
  PointValues measured_by_paths(const ProgressCallback& progress) {
    PointsRun run = run_of(Round::by_paths);
    run.progress = progress;
    return measure_points(by_paths(), places_, plans_, run);
  }
  // Audits points by cells. Adds a bias to their errors, or measures them by paths.
  void check(PointValues& found) {
    const auto finding = audit(by_paths(), places_, found.values, plan_, run_of(Round::audit));
    if (!finding) {
      found.is_cut_short = true;
      return;
    }
    if (finding->bias == 0 && !finding->is_worth_paths) {
      combine_measurements(*finding, found.values);
      return;
    }
    if (finding->needed_second_look && !finding->is_worth_paths) {
      add_bias_to_errors(finding->bias, found.values);
      return;
    }
    // New random numbers: those of the audit led to this decision.
    const PointValues all = measured_by_paths(nullptr);
    found.is_cut_short = !all.is_complete();
    if (!all.is_complete()) return;
    for (size_t i = 0; i < found.values.size(); ++i)
      replace_by_paths(all.values[i].indirect, finding->bias, found.values[i]);
  }

  const PreparedScene& scene_;
  const std::vector<MeasuringPlace>& places_;
  const MeasureOptions& options_;
  const Preparation* preparation_;
  MethodSettings settings_;
  PointPlan plan_;
  std::vector<PointPlan> plans_{plan_by_paths(plan_)};  // plans by paths
  int samples_of_batch_;
  double rays_of_audit_ = 0;
  std::unique_ptr<Integrator> by_paths_;
  const ProgressCallback& progress_;
  const StopFlag& stop_;
};

}  // namespace

int default_samples(Method method) {
  return method.row().usual_measuring_samples;
}

MeasureResult measure(const PreparedScene& scene, const std::vector<MeasuringPoint>& points,
                      const MeasureOptions& options, const ProgressCallback& progress,
                      const StopFlag& stop) {
  const Preparation* preparation = options.preparation;
  std::unique_ptr<Preparation> own;
  if (needs_radiosity(options.method, options.indirect) && preparation == nullptr) {
    own = prepare(scene, options.method, options.kj92, options.indirect, std::nullopt,
                  options.threads, nullptr, stop);
    if (!own) return nothing_measured(points.size());
    preparation = own.get();
  }
  const std::vector<MeasuringPlace> places = measuring_places(scene, points);
  const PointValues found =
      PointsMeasuring(scene, places, options, preparation, progress, stop).values();
  if (found.values.size() < points.size()) return nothing_measured(points.size());
  MeasureResult result;
  result.is_complete = found.is_complete() && !found.is_cut_short;
  for (const PointLight& v : found.values) result.values.push_back(v.all);
  result.in_surfaces = in_others(places);
  result.counters = found.all_counters();
  result.is_measured.assign(found.is_measured.begin(), found.is_measured.end());
  return result;
}

}  // namespace troffer
