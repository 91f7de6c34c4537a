#include "render/measured_points.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <string>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"
#include "render/sample_sets.h"

namespace troffer {

namespace {

// Stops are looked for between batches: those of scenes with many sources are smaller.
constexpr int largest_batch = 4096;
constexpr double most_rays_per_batch = 1 << 22;
// Where direct light takes part in fewer samples than every so many-th, batches are as many times
// as large: what certificates find out about a point serves the direct samples of a batch, and for
// a few of them nothing is proved, so that each errs by far more than one of many.
constexpr int usual_samples_per_direct = 32;
constexpr int most_times_larger = 32;

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
  double luminance_of_images = 0;  // RadianceBatch::images
  double shared_error = 0;         // as RadianceBatch::drawn_error has it
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

// Sums of so many samples of each set at the worker's point, set by set; cut short by a stop.
// Batches go on from set to set: what light certificates find out about the point serves all.
std::vector<Sums> sums_of_sets(const Integrator& integrator, uint64_t stream, int sets, int samples,
                               const StopFlag& stop, Worker& w, Counters& counters) {
  std::vector<Sums> sums(static_cast<size_t>(sets));
  const int all = sets * samples;
  const int per_batch =
      w.samples_per_batch * std::clamp(int(w.sensors.samples_per_direct) / usual_samples_per_direct,
                                       1, most_times_larger);
  for (int first = 0; first < all; first += per_batch) {
    if (stop.load(std::memory_order_relaxed)) break;
    const int count = std::min(per_batch, all - first);
    w.sensors.positions.assign(size_t(count), w.place.position);
    w.sensors.normals.assign(size_t(count), w.place.normal);
    w.sensors.streams.clear();
    w.sensors.samples.clear();
    for (int i = first; i < first + count; ++i) {
      w.sensors.streams.push_back(hash_combine(stream, uint64_t(i / samples)));
      w.sensors.samples.push_back(uint32_t(i % samples));
    }
    w.out.reset(size_t(count));
    const CheckContext context(&w, size_t(count), name_of_sensor);
    integrator.irradiance(w.sensors, *w.scratch, w.out, counters);
    for (size_t i = 0; i < size_t(count); ++i) {
      const Rgb e = w.out.direct[i] + w.out.indirect[i];
      if (!is_finite(e)) {
        ++counters.nan_samples;
        continue;
      }
      Sums& s = sums[(size_t(first) + i) / size_t(samples)];
      s.direct.add(w.out.direct[i]);
      s.indirect.add(w.out.indirect[i]);
      if (!w.out.images.empty()) s.luminance_of_images += double(luminance(w.out.images[i]));
      if (!w.out.drawn_error.empty()) s.shared_error += double(w.out.drawn_error[i]);
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
  SampleSets all, direct, indirect, seldom, often;
  w.shared_error = 0;
  w.sensors.samples_per_direct = uint32_t(plan.samples_per_direct);
  for (const Sums& s : sums_of_sets(integrator, stream, sets, estimates, stop, w, counters)) {
    all.add((s.direct.irradiance + s.indirect.irradiance) * weight,
            (s.direct.luminance + s.indirect.luminance) * weight);
    direct.add(s.direct.irradiance * weight, s.direct.luminance * weight);
    indirect.add(s.indirect.irradiance * weight, s.indirect.luminance * weight);
    seldom.add({}, (s.direct.luminance + s.luminance_of_images) * weight);
    often.add({}, (s.indirect.luminance - s.luminance_of_images) * weight);
    w.shared_error += s.shared_error * (weight / sets);
  }
  return {measurement_of(all, plan.lx_per_unit), measurement_of(direct, plan.lx_per_unit),
          measurement_of(indirect, plan.lx_per_unit), seldom.standard_error() * plan.lx_per_unit,
          often.standard_error() * plan.lx_per_unit};
}

// The same, and once more where the error is larger than the plan has it. The first samples only
// say how many are taken then: were they used again, a sum that is small by chance, with a small
// error, would stay, and one that is large would not.
PointLight measure_to_error(const Integrator& integrator, uint64_t stream, const PointPlan& plan,
                            const StopFlag& stop, Worker& w, Counters& counters) {
  const PointLight first = measure_point(integrator, stream, plan, stop, w, counters);
  const PointPlan enough = enough_for(first, plan);
  if (enough.samples == plan.samples && enough.samples_per_direct == plan.samples_per_direct)
    return first;  // as planned, or nothing more is allowed
  return measure_point(integrator, hash_of(stream, 1u), enough, stop, w, counters);
}

}  // namespace

Counters PointValues::all_counters() const {
  Counters sum;
  for (const Counters& c : counters) sum += c;
  return sum;
}

int samples_per_batch(double rays_per_sample) {
  return int(std::clamp(most_rays_per_batch / rays_per_sample, 1.0, double(largest_batch)));
}

PointValues measure_points(const Integrator& integrator, const std::vector<MeasuringPlace>& places,
                           std::span<const PointPlan> plans, const PointsRun& run) {
  const size_t points = places.size();
  PointValues found{std::vector<PointLight>(points), std::vector<uint8_t>(points, 0),
                    std::vector<double>(points, 0), std::vector<Counters>(points)};
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
        measure_to_error(integrator, hash_of(run.seed, i), plans[plans.size() > 1 ? i : 0],
                         run.stop, w, found.counters[i]);
    found.shared_errors[i] = w.shared_error;
    if (run.stop.load(std::memory_order_relaxed)) return;  // its sums may have been cut short
    found.is_measured[i] = 1;
    const std::lock_guard lock(progress_mutex);
    ++found.done;
    if (run.progress) run.progress(double(found.done) / double(points));
  });
  return found;
}

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

}  // namespace troffer
