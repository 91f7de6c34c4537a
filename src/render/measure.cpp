#include "render/measure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"
#include "integrate/path.h"
#include "render/audit.h"
#include "render/measuring_places.h"

namespace troffer {

namespace {

// The samples of a point are dealt to so many independently scrambled sets; the spread of their
// means tells the error truly, which the spread of stratified samples would not.
constexpr int most_replicates = 32;
// Of a point whose usual samples err by more than this share of the allowed error …
constexpr double share_of_error = 0.25;
// … at most so many times as many are taken.
constexpr double most_times_usual = 128;
// Stops are looked for between batches: those of scenes with many sources are smaller.
constexpr int largest_batch = 4096;
constexpr double most_rays_per_batch = 1 << 22;

// Two-sided 95 % quantile of Student's t with n degrees of freedom, within 0.3 % for n >= 1
// (Cornish-Fisher expansion about the normal quantile; exact values for the first few).
double t_quantile_95(int n) {
  constexpr std::array<double, 5> exact{12.7062, 4.3027, 3.1824, 2.7764, 2.5706};
  if (n <= 5) return exact[size_t(n - 1)];
  const double z = 1.959964, z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
  const double v = n;
  return z + (z3 + z) / (4 * v) + (5 * z5 + 16 * z3 + 3 * z) / (96 * v * v) +
         (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * v * v * v);
}

struct Sums {
  Vec3d irradiance;
  double luminance = 0;
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

// Sum of `samples` estimates of one replicate at the worker's point; cut short by a stop.
Sums sum_of_replicate(const Integrator& integrator, uint64_t stream, int samples,
                      const StopFlag& stop, Worker& w, Counters& counters) {
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
      sums.irradiance += Vec3d{double(e.r), double(e.g), double(e.b)};
      sums.luminance += double(luminance(e));
      if (!w.out.drawn_error.empty()) sums.shared_error += double(w.out.drawn_error[i]);
    }
  }
  return sums;
}

// How a point is measured.
struct PointPlan {
  int samples;
  int samples_per_estimate;
  double error = 0;  // relative, that is aimed at; 0: so many samples do
  double lx_per_unit = 1;
};

Measurement measure_point(const Integrator& integrator, uint64_t stream, const PointPlan& plan,
                          const StopFlag& stop, Worker& w, Counters& counters) {
  const int spp = plan.samples, samples_per_estimate = plan.samples_per_estimate;
  const int replicates = std::min(most_replicates, spp);
  const int samples = (spp + replicates - 1) / replicates;
  Vec3d irradiance;
  double mean = 0, sum_squares = 0;
  w.shared_error = 0;
  for (int r = 0; r < replicates; ++r) {
    const Sums s = sum_of_replicate(integrator, hash_combine(stream, uint64_t(r)),
                                    std::max(1, samples / samples_per_estimate), stop, w, counters);
    const double weight = 1.0 / std::max(1, samples / samples_per_estimate);
    irradiance += s.irradiance * (weight / replicates);
    w.shared_error += s.shared_error * (weight / replicates);
    const double value = s.luminance * weight, before = value - mean;
    mean += before / (r + 1);
    sum_squares += before * (value - mean);
  }
  Measurement m;
  m.irradiance = {float(irradiance.x), float(irradiance.y), float(irradiance.z)};
  m.illuminance_lx = mean * plan.lx_per_unit;
  if (replicates > 1) {
    const double variance_of_mean = sum_squares / (replicates - 1) / replicates;
    m.standard_error =
        std::sqrt(variance_of_mean) * plan.lx_per_unit * (t_quantile_95(replicates - 1) / 1.959964);
  }
  return m;
}

// The same, and once more where the error is larger than the plan has it. The first samples only
// say how many are taken then: were they used again, a sum that is small by chance, with a small
// error, would stay, and one that is large would not.
Measurement measure_to_error(const Integrator& integrator, uint64_t stream, PointPlan plan,
                             const StopFlag& stop, Worker& w, Counters& counters) {
  const Measurement first = measure_point(integrator, stream, plan, stop, w, counters);
  const double aim = plan.error * first.illuminance_lx;
  if (!(aim > 0) || first.standard_error <= aim) return first;
  const double times = std::min(sqr(first.standard_error / aim), most_times_usual);
  plan.samples = int(double(plan.samples) * std::exp2(std::ceil(std::log2(times))));
  return measure_point(integrator, hash_of(stream, 1u), plan, stop, w, counters);
}

// What the method knows of errors that no spread of its samples shows: half the difference between
// two halves of what it has learnt is one draw of that error. Relative to the light it is much the
// same at all points.
void add_shared_errors(const std::vector<double>& of_luminance, double lx_per_unit,
                       std::vector<Measurement>& values) {
  double squares = 0;
  int points = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    if (!(values[i].illuminance_lx > 0)) continue;
    squares += sqr(of_luminance[i] * lx_per_unit / values[i].illuminance_lx);
    ++points;
  }
  if (!(squares > 0)) return;
  const double relative = std::sqrt(squares / points) * t_quantile_95(points) / 1.959964;
  for (Measurement& m : values)
    m.standard_error = std::hypot(m.standard_error, relative * m.illuminance_lx);
}

struct PointsRun {
  uint64_t seed = 0;
  int threads = 0;
  int samples_per_batch = largest_batch;
  const ProgressCallback& progress;
  const StopFlag& stop;
};

struct PointValues {
  std::vector<Measurement> values;
  std::vector<uint8_t> is_measured;
  std::vector<double> shared_errors;  // of the luminance of irradiance
  std::vector<Counters> counters;
  size_t done = 0;
};

PointValues measure_points(const Integrator& integrator, const std::vector<MeasuringPlace>& places,
                           const PointPlan& plan, const PointsRun& run) {
  const size_t points = places.size();
  PointValues found{std::vector<Measurement>(points), std::vector<uint8_t>(points, 0),
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

// Every so many-th of them, so that a long list takes little longer.
std::vector<size_t> audited_of(size_t points) {
  constexpr size_t most = 32;
  std::vector<size_t> which;
  for (size_t i = 0; i < points; i += (points + most - 1) / most) which.push_back(i);
  return which;
}

// Looks at points that were measured by cells by paths; false where a stop came before.
bool audit(const PreparedScene& scene, const std::vector<MeasuringPlace>& places,
           const MeasureOptions& options, PointPlan plan, const StopFlag& stop,
           std::vector<Measurement>& values) {
  constexpr int paths_per_sample = 4;
  const std::vector<size_t> which = audited_of(places.size());
  std::vector<MeasuringPlace> at;
  std::vector<Measurement> audited;
  for (const size_t i : which) {
    at.push_back(places[i]);
    audited.push_back(values[i]);
  }
  plan = {plan.samples * paths_per_sample, 1, 0, plan.lx_per_unit};
  const PathIntegrator by_paths(scene, {options.depth, false, {}});
  const PointValues paths = measure_points(
      by_paths, at, plan,
      {hash_of(options.seed, uint64_t{0x6175'6469}), options.threads, largest_batch, {}, stop});
  if (paths.done < at.size()) return false;
  add_error(values, relative_bias(audited, paths.values));
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

  PointPlan plan{spp, row.rays_of_measuring_sample, 0,
                 scene.scene.is_photometric ? 1.0 : luminous_efficacy};
  if (row.measures_to_error && options.spp == 0) plan.error = share_of_error * options.error;

  PointValues found =
      measure_points(*integrator, places, plan,
                     {options.seed, options.threads, samples_per_batch, progress, stop});
  add_shared_errors(found.shared_errors, plan.lx_per_unit, found.values);
  MeasureResult result;
  result.is_complete = found.done == points.size();
  if (result.is_complete && needs_cells(options.method, options.indirect))
    result.is_complete = audit(scene, places, options, plan, stop, found.values);
  result.values = std::move(found.values);
  result.in_surfaces = in_others(places);
  for (const Counters& c : found.counters) result.counters += c;
  result.is_measured.assign(found.is_measured.begin(), found.is_measured.end());
  return result;
}

}  // namespace troffer
