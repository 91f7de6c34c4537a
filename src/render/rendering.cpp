#include "render/rendering.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"
#include "render/preview.h"

namespace troffer {

namespace {

int passes_of(int samples) {
  return (samples + samples_per_batch - 1) / samples_per_batch;
}

}  // namespace

Rendering::Rendering(const PreparedScene& scene, const ViewingCamera& camera,
                     const Integrator& integrator, const RenderOptions& options, TilePlan plan,
                     const ProgressCallback& progress, const StopFlag& stop)
    : scene_(scene),
      camera_(camera),
      integrator_(integrator),
      options_(options),
      plan_(std::move(plan)),
      film_(plan_.region, options.aovs, scene.scene.origin),
      work_(size_t(thread_count(options.threads))),
      report_(progress),
      stop_(stop) {
  const PixelSampling sampling = integrator.sampling();
  refining_.first_spp = std::max(options.spp, sampling.first);
  refining_.max_spp = std::max(most_viewing_rays(options), sampling.most);
  // By as many rays as a pixel may come to: what a footprint takes from beside a narrow surface no
  // further ray mends.
  for (Work& w : work_)
    w.rays.cone = camera.cone(std::max(options.spp, most_viewing_rays(options)));
  if (refining_.max_spp > refining_.first_spp) {
    refining_.records.emplace(plan_.region);
    if (sampling.is_by_noise()) {
      refining_.options.error = float(sampling.error);
      refining_.options.is_everywhere = refining_.options.is_noise = true;
    }
    refining_.can_glance = integrator.can_glance();
    if (refining_.can_glance) {
      film_.expect_glances();
      refining_.options.error = float(options.error);
      refining_.options.is_everywhere = true;
      refining_.options.most_even = 6;
    }
  }
  const int passes = refines_at_once() ? 1 : passes_of(refining_.max_spp - refining_.first_spp);
  progress_.tiles_in_all = plan_.tiles.size() * size_t(passes_of(refining_.first_spp) + passes);
}

bool Rendering::run() {
  const bool wants_typical = options_.method.row().wants_typical;
  const auto typical = wants_typical ? float(typical_luminance()) : 0;
  for (Work& w : work_) w.radiance.typical = typical;
  for (int first = 0; first < refining_.first_spp && !was_stopped_; first += samples_per_batch) {
    const auto count = uint32_t(std::min(samples_per_batch, refining_.first_spp - first));
    pass([&](const PixelRect& tile, Work& w) {
      for (const Pixel2& p : pixels_in_order(tile)) add_rays(p, count, w);
    });
  }
  if (refining_.records && !was_stopped_) refine();
  return !was_stopped_;
}

std::vector<Layer> Rendering::layers() const {
  std::vector<Layer> layers = film_.layers();
  for (Layer& l : layers) l.image = part_of(l.image, plan_.region, plan_.window);
  return layers;
}

ViewingErrors Rendering::viewing_errors() const {
  const PixelRect& w = plan_.window;
  ViewingErrors e;
  const double mean = mean_luminance();
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      const PixelEstimate p = film_.estimate(x, y);
      e.relative_rms += sqr(p.standard_error);
      constexpr double percent = 0.01;
      const double allowed = percent * std::max(p.luminance, mean);
      e.share_above += p.standard_error > allowed ? 1 : 0;
    }
  const double pixels = double(w.width()) * w.height();
  e.relative_rms = mean > 0 ? std::sqrt(e.relative_rms / pixels) / mean : 0;
  e.share_above /= pixels;
  return e;
}

Counters Rendering::counters() const {
  Counters sum;
  for (const Work& w : work_) sum += w.counters;
  return sum;
}

std::string Rendering::name_of_ray(const void* work, size_t i) {
  const Work& w = *static_cast<const Work*>(work);
  return "pixel (" + std::to_string(w.pixels[i].x) + "," + std::to_string(w.pixels[i].y) +
         "), sample " + std::to_string(w.rays.samples[i]);
}

// The rays that `fill` adds are traced, and what they bring is added to the film.
void Rendering::pass(const Fill& fill) {
  parallel_for_slots(plan_.tiles.size(), options_.threads, [&](size_t t, size_t slot) {
    if (stop_.load(std::memory_order_relaxed)) {
      was_stopped_ = true;
      return;
    }
    Work& w = work_[slot];
    if (!w.scratch) w.scratch = integrator_.make_scratch();
    w.rays.clear();
    w.pixels.clear();
    fill(plan_.tiles[t], w);
    const CheckContext context(&w, w.rays.size(), name_of_ray);
    if (w.rays.size() > 0) trace(w);
    tell_progress(plan_.tiles[t]);
  });
}

// Of a tile that this thread has just been busy with.
void Rendering::tell_progress(const PixelRect& tile) {
  if (options_.preview != nullptr) options_.preview->update(film_, tile);
  const std::lock_guard lock(progress_.mutex);
  ++progress_.tiles_done;
  if (report_)
    report_(std::min(1.0, double(progress_.tiles_done) / double(progress_.tiles_in_all)));
}

// The next `count` viewing rays of a pixel.
void Rendering::add_rays(const Pixel2& p, uint32_t count, Work& w) const {
  add_viewing_rays(camera_, p, film_.estimate(p.x, p.y).samples, count, options_.seed, w.rays);
  w.pixels.resize(w.rays.size(), p);
}

void Rendering::trace(Work& w) {
  w.radiance.reset(w.rays.size());
  if (refining_.records) w.radiance.records.assign(w.rays.size(), {});
  if (refining_.can_glance) w.radiance.known.assign(w.rays.size(), {});
  integrator_.radiance(w.rays, *w.scratch, w.radiance, w.counters);
  for (size_t i = 0; i < w.rays.size(); ++i) {
    const auto [x, y] = w.pixels[i];
    const bool is_first = film_.estimate(x, y).samples == 0;
    const float depth = camera_.depth(w.radiance.position[i]);
    if (!film_.add(x, y, w.radiance, i, depth)) ++w.counters.nan_samples;
    // Refinement compares with what the first pass saw, and does not change it.
    if (refining_.records && !refining_.has_begun)
      refining_.records->note(x, y, std::move(w.radiance.records[i]), is_first);
  }
}

// Further rays, as many as the first pass has called for, in passes that fit a batch.
void Rendering::refine() {
  const bool is_same_in_crops = options_.method.row().is_same_in_crops;
  const double typical = is_same_in_crops ? typical_luminance() : mean_luminance();
  const PixelRecords& records = *refining_.records;
  const FurtherRays wanted = further_rays(typical);
  refining_.has_begun = true;
  if (refining_.can_glance) glance(wanted.glances);
  if (refines_at_once()) return refine(wanted.samples);
  for (int first = refining_.first_spp; first < refining_.max_spp && !was_stopped_;
       first += samples_per_batch) {
    pass([&](const PixelRect& tile, Work& w) {
      for (const Pixel2& p : pixels_in_order(tile)) {
        const int count =
            std::min(samples_per_batch, wanted.samples[records.index(p.x, p.y)] - first);
        if (count <= 0) continue;
        add_rays(p, uint32_t(count), w);
        w.rays.neighbours.resize(w.rays.size(), records.around(p.x, p.y));
      }
    });
  }
}

// All further rays of a tile at once: few pixels may get many.
void Rendering::refine(const std::vector<int>& wanted) {
  parallel_for_slots(plan_.tiles.size(), options_.threads, [&](size_t t, size_t slot) {
    if (stop_.load(std::memory_order_relaxed)) {
      was_stopped_ = true;
      return;
    }
    refine(plan_.tiles[t], wanted, work_[slot]);
    tell_progress(plan_.tiles[t]);
  });
}

void Rendering::refine(const PixelRect& tile, const std::vector<int>& wanted, Work& w) {
  constexpr size_t rays_at_a_time = 1024;
  const auto clear = [&] {
    w.rays.clear();
    w.pixels.clear();
  };
  const auto send = [&] {
    const CheckContext context(&w, w.rays.size(), name_of_ray);
    if (w.rays.size() > 0) trace(w);
    clear();
  };
  if (!w.scratch) w.scratch = integrator_.make_scratch();
  clear();
  for (const Pixel2& p : pixels_in_order(tile)) {
    int left = wanted[refining_.records->index(p.x, p.y)] - refining_.first_spp;
    while (left > 0 && !stop_.load(std::memory_order_relaxed)) {
      const int count = std::min(left, int(rays_at_a_time - w.rays.size()));
      add_rays(p, uint32_t(count), w);
      left -= count;
      if (w.rays.size() == rays_at_a_time) send();
    }
  }
  send();
}

// How many of them the pixels of the region get, by what the first pass has seen.
Rendering::FurtherRays Rendering::further_rays(double typical) const {
  const PixelRecords& records = *refining_.records;
  const EdgeMap edges(scene_, camera_, plan_.region, options_.threads);
  const RefinementView view{film_, records, edges, typical};
  FurtherRays wanted;
  wanted.samples.assign(records.records.size(), refining_.first_spp);
  wanted.glances.assign(records.records.size(), 0);
  const PixelRect& r = plan_.inner;
  parallel_for(size_t(r.height()), options_.threads, [&](size_t row) {
    const int y = r.y0 + int(row);
    for (int x = r.x0; x < r.x1; ++x) {
      const size_t i = records.index(x, y);
      if (refining_.can_glance) wanted.glances[i] = glances_wanted(view, x, y, refining_.options);
      wanted.samples[i] = samples_wanted(view, x, y, wanted.glances[i] > 0, refining_.first_spp,
                                         refining_.max_spp, refining_.options);
    }
  });
  return wanted;
}

// Rays that look at what is known, where that varies within a pixel.
void Rendering::glance(const std::vector<int>& wanted) {
  parallel_for_slots(plan_.tiles.size(), options_.threads, [&](size_t t, size_t slot) {
    if (stop_.load(std::memory_order_relaxed))
      was_stopped_ = true;
    else
      glance(plan_.tiles[t], wanted, work_[slot]);
  });
}

void Rendering::glance(const PixelRect& tile, const std::vector<int>& wanted, Work& w) {
  constexpr size_t rays_at_a_time = 1024;
  const uint64_t seed = hash_of(options_.seed, uint64_t{0x676c'616e});  // not that of samples
  if (!w.scratch) w.scratch = integrator_.make_scratch();
  w.rays.clear();
  w.pixels.clear();
  const auto send = [&] {
    const CheckContext context(&w, w.rays.size(), name_of_ray);
    w.radiance.reset(w.rays.size());
    w.radiance.known.assign(w.rays.size(), {});
    integrator_.glance(w.rays, *w.scratch, w.radiance, w.counters);
    for (size_t i = 0; i < w.rays.size(); ++i)
      film_.add_glance(w.pixels[i].x, w.pixels[i].y, w.radiance, i,
                       camera_.depth(w.radiance.position[i]));
    w.rays.clear();
    w.pixels.clear();
  };
  for (const Pixel2& p : pixels_in_order(tile)) {
    const int count = wanted[refining_.records->index(p.x, p.y)];
    add_viewing_rays(camera_, p, 0, uint32_t(count), seed, w.rays);
    w.pixels.resize(w.rays.size(), p);
    if (w.rays.size() >= rays_at_a_time) send();
  }
  send();
}

// Mean luminance of the whole picture but its brightest twentieth (what shines), from few rays,
// which are no part of the picture and of its statistics.
double Rendering::typical_luminance() {
  if (refining_.typical) return *refining_.typical;
  constexpr int most = 16;  // rays along each side
  Work& w = work_[0];
  if (!w.scratch) w.scratch = integrator_.make_scratch();
  w.rays.clear();
  w.pixels.clear();
  const uint64_t seed = hash_of(options_.seed, uint64_t{0x7479'7069});  // not the picture's own
  const int width = plan_.image.width(), height = plan_.image.height();
  const int nx = std::min(most, width), ny = std::min(most, height);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      w.pixels.push_back({i * width / nx, j * height / ny});
      add_viewing_rays(camera_, w.pixels.back(), 0, 1, seed, w.rays);
    }
  const CheckContext context(&w, w.rays.size(), name_of_ray);
  w.radiance.reset(w.rays.size());
  Counters uncounted;
  w.radiance.is_rough = true;
  integrator_.radiance(w.rays, *w.scratch, w.radiance, uncounted);
  w.radiance.is_rough = false;
  std::vector<double> values;
  for (size_t i = 0; i < w.rays.size(); ++i) {
    const Rgb l = w.radiance.direct[i] + w.radiance.indirect[i];
    values.push_back(is_finite(l) ? double(luminance(l)) : 0);
  }
  std::sort(values.begin(), values.end());
  values.resize(values.size() - values.size() / 20);
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
  refining_.typical = mean;
  return mean;
}

double Rendering::mean_luminance() const {
  const PixelRect& w = plan_.window;
  double sum = 0;
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) sum += film_.estimate(x, y).luminance;
  return sum / (double(w.width()) * w.height());
}

}  // namespace troffer
