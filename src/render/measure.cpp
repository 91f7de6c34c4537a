#include "render/measure.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"
#include "integrate/path.h"
#include "render/audit.h"
#include "render/measuring_places.h"
#include "render/point_plan.h"
#include "render/sample_sets.h"

namespace troffer {

namespace {

// Points whose usual samples err by more than this share of the allowed error get more of them.
constexpr double share_of_error = 0.25;
// Paths of a point that is audited, for each of its samples; and so many times as many at most
// where all points are measured by paths.
constexpr int paths_of_sample = 4;
constexpr double most_times_audit = 16;
constexpr double much_more = 2;  // than another error
// Stops are looked for between batches: those of scenes with many sources are smaller.
constexpr int largest_batch = 4096;
constexpr double most_rays_per_batch = 1 << 22;

struct Sum {
  Vec3d irradiance;
  double luminance = 0;
  void add(const Rgb& e) {
    irradiance += Vec3d{double(e.r), double(e.g), double(e.b)};
    luminance += double(troffer::luminance(e));
  }
};
struct Sums {
  Sum direct, indirect;
  double shared_error = 0;  // as RadianceBatch::drawn_error has it
};

struct Worker {
  size_t point = 0;  // its number in the list
  MeasuringPlace place;
  SensorBatch sensors;  // of this point
  RadianceBatch out;
  double shared_error = 0;  // of the point's mean
  std::unique_ptr<IntegratorScratch> scratch;
  int samples_per_batch = largest_batch;
};

std::string name_of_sensor(const void* worker, size_t i) {
  const Worker& w = *static_cast<const Worker*>(worker);
  return "point " + std::to_string(w.point) + ", sample " + std::to_string(w.sensors.samples[i]);
}

// Sum of `samples` estimates of one set at the worker's point; cut short by a stop.
Sums sum_of_set(const Integrator& integrator, uint64_t stream, int samples, const StopFlag& stop,
                Worker& w, Counters& counters) {
  Sums sums;
  for (int first = 0; first < samples; first += w.samples_per_batch) {
    if (stop.load(std::memory_order_relaxed)) break;
    const auto count = size_t(std::min(w.samples_per_batch, samples - first));
    w.sensors.positions.assign(count, w.place.position);
    w.sensors.normals.assign(count, w.place.normal);
    w.sensors.streams.assign(count, stream);
    w.sensors.samples.resize(count);
    for (size_t i = 0; i < count; ++i) w.sensors.samples[i] = uint32_t(first) + uint32_t(i);
    w.out.reset(count);
    const CheckContext context(&w, count, name_of_sensor);
    integrator.irradiance(w.sensors, *w.scratch, w.out, counters);
    for (size_t i = 0; i < count; ++i) {
      const Rgb e = w.out.direct[i] + w.out.indirect[i];
      if (!is_finite(e)) {
        ++counters.nan_samples;
        continue;
      }
      sums.direct.add(w.out.direct[i]);
      sums.indirect.add(w.out.indirect[i]);
      if (!w.out.drawn_error.empty()) sums.shared_error += double(w.out.drawn_error[i]);
    }
  }
  return sums;
}

Measurement measurement_of(const SampleSets& sets, double lx_per_unit) {
  const Vec3d& e = sets.irradiance();
  return {{float(e.x), float(e.y), float(e.z)},
          sets.luminance() * lx_per_unit,
          sets.standard_error() * lx_per_unit};
}

PointLight measure_point(const Integrator& integrator, uint64_t stream, const PointPlan& plan,
                         const StopFlag& stop, Worker& w, Counters& counters) {
  const int sets = std::min(most_sets, plan.samples);
  const int estimates = std::max(1, (plan.samples + sets - 1) / sets / plan.samples_per_estimate);
  const double weight = 1.0 / estimates;
  SampleSets all, direct, indirect;
  w.shared_error = 0;
  w.sensors.samples_per_direct = uint32_t(plan.samples_per_direct);
  for (int k = 0; k < sets; ++k) {
    const Sums s =
        sum_of_set(integrator, hash_combine(stream, uint64_t(k)), estimates, stop, w, counters);
    all.add((s.direct.irradiance + s.indirect.irradiance) * weight,
            (s.direct.luminance + s.indirect.luminance) * weight);
    direct.add(s.direct.irradiance * weight, s.direct.luminance * weight);
    indirect.add(s.indirect.irradiance * weight, s.indirect.luminance * weight);
    w.shared_error += s.shared_error * (weight / sets);
  }
  return {measurement_of(all, plan.lx_per_unit), measurement_of(direct, plan.lx_per_unit),
          measurement_of(indirect, plan.lx_per_unit)};
}

// The same, and once more where the error is larger than the plan has it. The first samples only
// say how many are taken then: were they used again, a sum that is small by chance, with a small
// error, would stay, and one that is large would not.
PointLight measure_to_error(const Integrator& integrator, uint64_t stream, const PointPlan& plan,
                            const StopFlag& stop, Worker& w, Counters& counters) {
  const PointLight first = measure_point(integrator, stream, plan, stop, w, counters);
  if (is_as_planned(first, plan)) return first;
  return measure_point(integrator, hash_of(stream, 1u), enough_for(first, plan), stop, w, counters);
}

// What the method knows of errors that no spread of its samples shows: half the difference between
// two halves of what it has learnt is one draw of that error. Relative to the light it is much the
// same at all points.
void add_shared_errors(const std::vector<double>& of_luminance, double lx_per_unit,
                       std::vector<PointLight>& values) {
  double squares = 0;
  int points = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    if (!(values[i].all.illuminance_lx > 0)) continue;
    squares += sqr(of_luminance[i] * lx_per_unit / values[i].all.illuminance_lx);
    ++points;
  }
  if (!(squares > 0)) return;
  const double relative = std::sqrt(squares / points) * t_quantile_95(points) / 1.959964;
  for (PointLight& v : values)
    for (Measurement* m : {&v.all, &v.indirect})
      m->standard_error = std::hypot(m->standard_error, relative * v.all.illuminance_lx);
}

struct PointsRun {
  uint64_t seed = 0;
  int threads = 0;
  int samples_per_batch = largest_batch;
  const ProgressCallback& progress;
  const StopFlag& stop;
};

struct PointValues {
  std::vector<PointLight> values;
  std::vector<uint8_t> is_measured;
  std::vector<double> shared_errors;  // of the luminance of irradiance
  std::vector<Counters> counters;
  size_t done = 0;
};

PointValues measure_points(const Integrator& integrator, const std::vector<MeasuringPlace>& places,
                           const PointPlan& plan, const PointsRun& run) {
  const size_t points = places.size();
  PointValues found{std::vector<PointLight>(points), std::vector<uint8_t>(points, 0),
                    std::vector<double>(points, 0), std::vector<Counters>(points), 0};
  std::vector<Worker> workers(size_t(thread_count(run.threads)));
  std::mutex progress_mutex;
  parallel_for_slots(points, run.threads, [&](size_t i, size_t slot) {
    if (run.stop.load(std::memory_order_relaxed)) return;
    Worker& w = workers[slot];
    if (!w.scratch) w.scratch = integrator.make_scratch();
    w.place = places[i];
    w.sensors.offset = w.place.offset;
    w.samples_per_batch = run.samples_per_batch;
    w.point = i;
    found.values[i] =
        measure_to_error(integrator, hash_of(run.seed, i), plan, run.stop, w, found.counters[i]);
    found.shared_errors[i] = w.shared_error;
    if (run.stop.load(std::memory_order_relaxed)) return;  // its sums may have been cut short
    found.is_measured[i] = 1;
    const std::lock_guard lock(progress_mutex);
    ++found.done;
    if (run.progress) run.progress(double(found.done) / double(points));
  });
  return found;
}

// Indirect light by paths in place of that by cells, which is biased by about so much of it; but
// not where paths err by more.
void take_better(const Measurement& by_paths, double bias, PointLight& v) {
  const double more = bias * v.indirect.illuminance_lx;
  if (by_paths.standard_error >= std::hypot(v.indirect.standard_error, more)) {
    v.all.standard_error = std::hypot(v.all.standard_error, more);
    return;
  }
  v.all = {v.direct.irradiance + by_paths.irradiance,
           v.direct.illuminance_lx + by_paths.illuminance_lx,
           std::hypot(v.direct.standard_error, by_paths.standard_error)};
}

// Root mean square, relative to all light.
double relative_error(const std::vector<PointLight>& points, Measurement PointLight::*part) {
  double squares = 0;
  int lit = 0;
  for (const PointLight& p : points) {
    if (!(p.all.illuminance_lx > 0)) continue;
    squares += sqr((p.*part).standard_error / p.all.illuminance_lx);
    ++lit;
  }
  return lit > 0 ? std::sqrt(squares / lit) : 0;
}

// Whether points by cells err by more than is aimed at, and as many paths as are allowed, of which
// `few` were some, would err by much less.
bool is_worth_paths(const std::vector<PointLight>& by_cells, const std::vector<PointLight>& few,
                    double aim) {
  const double told = relative_error(by_cells, &PointLight::all);
  const double by_paths = relative_error(few, &PointLight::indirect) / std::sqrt(most_times_audit);
  return aim > 0 && told > much_more * aim && told > much_more * by_paths;
}

// Every so many-th of them, so that a long list takes little longer.
std::vector<size_t> audited_of(size_t points) {
  constexpr size_t most = 32;
  std::vector<size_t> which;
  for (size_t i = 0; i < points; i += (points + most - 1) / most) which.push_back(i);
  return which;
}

// Measures light that was reflected before, of points that were measured by cells, by paths as
// well: few points, and where cells are found wrong there, or far from sure, all. False where a
// stop came before.
bool audit(const PreparedScene& scene, const std::vector<MeasuringPlace>& places,
           const MeasureOptions& options, const PointPlan& plan, const StopFlag& stop,
           std::vector<PointLight>& values) {
  std::vector<MeasuringPlace> at;
  std::vector<Measurement> by_cells, by_paths;
  for (const size_t i : audited_of(places.size())) {
    at.push_back(places[i]);
    by_cells.push_back(values[i].indirect);
  }
  PointPlan of_paths{.samples = plan.samples * paths_of_sample,
                     .samples_per_estimate = 1,
                     .lx_per_unit = plan.lx_per_unit,
                     .most_times = most_times_audit,
                     .is_of_indirect = true};
  const PathIntegrator integrator(scene, {options.depth, false, {}});
  const auto measured = [&](const std::vector<MeasuringPlace>& points, uint64_t round) {
    return measure_points(integrator, points, of_paths,
                          {hash_of(options.seed, round, uint64_t{0x6175'6469}),
                           options.threads,
                           largest_batch,
                           {},
                           stop});
  };
  const PointValues few = measured(at, 0);
  if (few.done < at.size()) return false;
  for (const PointLight& p : few.values) by_paths.push_back(p.indirect);
  const double bias = relative_bias(by_cells, by_paths);
  if (bias == 0 && !is_worth_paths(values, few.values, plan.error)) return true;
  of_paths.error = plan.error;
  // By numbers of their own: those of the audit are why these are taken.
  const PointValues all = measured(places, 1);
  if (all.done < places.size()) return false;
  for (size_t i = 0; i < values.size(); ++i) take_better(all.values[i].indirect, bias, values[i]);
  return true;
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
  settings.depth = options.depth;
  settings.threads = options.threads;
  return settings;
}

}  // namespace

int default_samples(Method method) {
  return method.row().usual_measuring_samples;
}

MeasureResult measure(const PreparedScene& scene, const std::vector<MeasuringPoint>& points,
                      const MeasureOptions& options, const ProgressCallback& progress,
                      const StopFlag& stop) {
  const MethodRow& row = options.method.row();
  const int spp = options.spp > 0 ? options.spp : default_samples(options.method);
  const Preparation* preparation = options.preparation;
  std::unique_ptr<Preparation> own;
  if (needs_radiosity(options.method, options.indirect) && preparation == nullptr) {
    own = prepare(scene, options.method, options.kj92, options.indirect, std::nullopt,
                  options.threads, nullptr, stop);
    if (!own) return nothing_measured(points.size());
    preparation = own.get();
  }
  const MethodSettings settings = settings_of(options);
  const std::vector<MeasuringPlace> places = measuring_places(scene, points);
  CellInput cells{points_pilot(places), nullptr, options.seed, nullptr, stop, {}, {},
                  options.cells};
  const std::unique_ptr<Integrator> integrator =
      make_integrator(scene, options.method, settings, preparation, &cells);
  if (!integrator) return nothing_measured(points.size());
  const double rays_per_sample = row.rays_per_sample(settings, scene.scene.lights.size());
  const int samples_per_batch =
      int(std::clamp(most_rays_per_batch / rays_per_sample, 1.0, double(largest_batch)));

  PointPlan plan{.samples = spp,
                 .samples_per_estimate = row.rays_of_measuring_sample,
                 .lx_per_unit = scene.scene.is_photometric ? 1.0 : luminous_efficacy};
  if (row.measures_to_error && options.spp == 0) {
    plan.error = share_of_error * options.error;
    plan.samples_per_direct = row.measuring_samples_per_direct;
  }

  PointValues found =
      measure_points(*integrator, places, plan,
                     {options.seed, options.threads, samples_per_batch, progress, stop});
  add_shared_errors(found.shared_errors, plan.lx_per_unit, found.values);
  MeasureResult result;
  result.is_complete = found.done == points.size();
  if (result.is_complete && needs_cells(options.method, options.indirect))
    result.is_complete = audit(scene, places, options, plan, stop, found.values);
  for (const PointLight& v : found.values) result.values.push_back(v.all);
  result.in_surfaces = in_others(places);
  for (const Counters& c : found.counters) result.counters += c;
  result.is_measured.assign(found.is_measured.begin(), found.is_measured.end());
  return result;
}

}  // namespace troffer
