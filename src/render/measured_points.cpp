#include "render/measured_points.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <numeric>
#include <string>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"
#include "render/rare_light.h"
#include "render/sample_sets.h"

namespace troffer {

namespace {

// The program checks for stops between batches, so batches are smaller in scenes with many sources.
constexpr int largest_batch = 4096;
constexpr double most_rays_per_batch = 1 << 22;
// If fewer than every 32nd sample includes direct light, batches grow in proportion. The proofs
// about a point serve all direct samples of a batch. With too few of them nothing is proved, and
// each sample is much noisier.
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
};

struct Worker {
  size_t point = 0;  // index in the list
  MeasuringPlace place;
  SensorBatch sensors;  // samples of this point
  RadianceBatch out;
  float largest_draw = 0;  // maximum of RadianceBatch::largest_draw over batches
  NoiseDraws noise{};      // sum of RadianceBatch::noise over batches
  std::unique_ptr<IntegratorScratch> scratch;
  int samples_per_batch = largest_batch;
};

std::string name_of_sensor(const void* worker, size_t i) {
  const Worker& w = *static_cast<const Worker*>(worker);
  return "point " + std::to_string(w.point) + ", sample " + std::to_string(w.sensors.samples[i]);
}

// Returns the sums over `samples` samples of each set at the worker's point; incomplete after a
// stop. A batch may span sets, since the proofs about the point serve all of them.
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
    w.largest_draw = std::max(w.largest_draw, w.out.largest_draw);
    add_draws(w.noise, 1, w.out.noise);
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
    }
  }
  return sums;
}

// more: error of the luminance beyond the spread of the sets.
Measurement measurement_of(const SampleSets& sets, double lx_per_unit, double more = 0) {
  const Vec3d& e = sets.irradiance();
  return {{float(e.x), float(e.y), float(e.z)},
          sets.luminance() * lx_per_unit,
          std::hypot(sets.standard_error(), more) * lx_per_unit};
}

// Returns the least error assumed for a mean of direct light with sampled points on sources: the
// light of two such points. If no sample was occluded by chance, samples do not differ. Up to three
// occlusions in as many samples are plausible even then (95 % bound of none seen). Without this
// bound, adaptive sample counts would favour points that met too few occlusions.
double least_error_of_draws(const Worker& w, int samples) {
  return 2 * double(w.largest_draw) * double(w.sensors.samples_per_direct) / samples;
}

// Returns the error of a mean that all samples share, from its random draws.
double error_by_noise(const NoiseDraws& noise, int samples) {
  double squares = 0;
  for (const float d : noise) squares += sqr(double(d));
  return std::sqrt(squares / draws_of_noise) / samples;
}

PointLight measure_point(const Integrator& integrator, uint64_t stream, const PointPlan& plan,
                         const StopFlag& stop, Worker& w, Counters& counters) {
  const int sets = std::min(most_sets, plan.samples);
  const int estimates = std::max(1, (plan.samples + sets - 1) / sets / plan.samples_per_estimate);
  const double weight = 1.0 / estimates;
  SampleSets all, direct, indirect, seldom, often;
  w.largest_draw = 0;
  w.noise = {};
  w.sensors.samples_per_direct = uint32_t(plan.samples_per_direct);
  for (const Sums& s : sums_of_sets(integrator, stream, sets, estimates, stop, w, counters)) {
    all.add((s.direct.irradiance + s.indirect.irradiance) * weight,
            (s.direct.luminance + s.indirect.luminance) * weight);
    direct.add(s.direct.irradiance * weight, s.direct.luminance * weight);
    indirect.add(s.indirect.irradiance * weight, s.indirect.luminance * weight);
    seldom.add({}, (s.direct.luminance + s.luminance_of_images) * weight);
    often.add({}, (s.indirect.luminance - s.luminance_of_images) * weight);
  }
  const double lx = plan.lx_per_unit, least = least_error_of_draws(w, sets * estimates);
  const double more = std::sqrt(std::max(sqr(least) - sqr(direct.standard_error()), 0.0));
  PointLight light{measurement_of(all, lx, more), measurement_of(direct, lx, more),
                   measurement_of(indirect, lx)};
  light.direct_part_error = seldom.standard_error() * lx;
  light.other_part_error = often.standard_error() * lx;
  light.least_error = least * lx;
  light.kurtosis = indirect.kurtosis();
  light.samples = plan.samples;
  light.shared_error = error_by_noise(w.noise, sets * estimates) * lx;
  return light;
}

// Measures places of a list, with one worker per thread.
class Measuring {
 public:
  Measuring(const Integrator& integrator, const std::vector<MeasuringPlace>& places,
            std::span<const PointPlan> plans, const PointsRun& run, PointValues& found)
      : integrator_(integrator),
        places_(places),
        plans_(plans),
        run_(run),
        found_(found),
        workers_(size_t(thread_count(run.threads))) {}

  const PointPlan& plan(size_t i) const { return plans_[plans_.size() > 1 ? i : 0]; }

  // Measures each of `points` by its entry of `plans`; progress goes from `begin` to `end`.
  void measure(const std::vector<size_t>& points, const std::vector<PointPlan>& plans,
               uint64_t round, double begin, double end) {
    double all = 0, done = 0;
    for (const PointPlan& p : plans) all += p.samples;
    std::mutex mutex;
    parallel_for_slots(points.size(), run_.threads, [&](size_t k, size_t slot) {
      if (run_.stop.load(std::memory_order_relaxed)) return;
      const size_t i = points[k];
      Worker& w = workers_[slot];
      if (!w.scratch) w.scratch = integrator_.make_scratch();
      w.place = places_[i];
      w.sensors.offset = w.place.offset;
      w.samples_per_batch = run_.samples_per_batch;
      w.point = i;
      const uint64_t stream = hash_of(run_.seed, i);
      const PointLight light =
          measure_point(integrator_, round == 0 ? stream : hash_of(stream, round), plans[k],
                        run_.stop, w, found_.counters[i]);
      if (run_.stop.load(std::memory_order_relaxed)) return;  // its sums may be incomplete
      found_.values[i] = light;
      found_.is_measured[i] = 1;
      const std::lock_guard lock(mutex);
      done += plans[k].samples;
      if (run_.progress) run_.progress(begin + (end - begin) * done / all);
    });
  }

 private:
  const Integrator& integrator_;
  const std::vector<MeasuringPlace>& places_;
  std::span<const PointPlan> plans_;
  const PointsRun& run_;
  PointValues& found_;
  std::vector<Worker> workers_;
};

}  // namespace

Counters PointValues::all_counters() const {
  Counters sum;
  for (const Counters& c : counters) sum += c;
  return sum;
}

int samples_per_batch(double rays_per_sample) {
  return int(std::clamp(most_rays_per_batch / rays_per_sample, 1.0, double(largest_batch)));
}

// First samples of a point by cells only determine the final sample count and are discarded.
// Reusing them would be biased: sums that are small by chance have small errors and would be kept.
// Paths begin with many samples, so the bias is accepted there.
PointValues measure_points(const Integrator& integrator, const std::vector<MeasuringPlace>& places,
                           std::span<const PointPlan> plans, const PointsRun& run) {
  constexpr double share_of_first = 0.25;  // approximate share of the time
  const size_t points = places.size();
  PointValues found{std::vector<PointLight>(points), std::vector<uint8_t>(points, 0),
                    std::vector<Counters>(points)};
  Measuring measuring(integrator, places, plans, run, found);
  std::vector<size_t> which(points);
  std::iota(which.begin(), which.end(), size_t{0});
  std::vector<PointPlan> own, first, more;
  for (const size_t i : which) {
    own.push_back(measuring.plan(i));
    first.push_back(first_of(own.back()));
  }
  const bool are_all =
      std::all_of(own.begin(), own.end(), [](const PointPlan& p) { return !(p.error > 0); });
  const double after_first = are_all ? 1 : share_of_first;
  measuring.measure(which, first, 0, 0, after_first);
  raise_errors_for_rare_light(found.values, which);
  which.clear();
  const std::vector<PointPlan> enough = enough_for(found.values, own, run.spare_samples);
  for (size_t i = 0; i < points; ++i) {
    // nothing more is needed or allowed
    if (enough[i].samples == first[i].samples &&
        enough[i].samples_per_direct == first[i].samples_per_direct)
      continue;
    found.is_measured[i] = 0;
    which.push_back(i);
    more.push_back(enough[i]);
  }
  if (which.empty() && after_first < 1 && run.progress) run.progress(1);
  measuring.measure(which, more, 1, after_first, 1);
  raise_errors_for_rare_light(found.values, which);
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
