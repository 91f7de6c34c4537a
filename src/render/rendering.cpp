#include "render/rendering.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/deadline.h"
#include "base/error.h"
#include "base/units.h"
#include "render/checkpoint.h"
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
      book_(plan_.tiles.size(), work_.size(), options.checkpoint != nullptr),
      report_(progress),
      stop_(stop) {
  const PixelSampling sampling = integrator.sampling();
  const MostViewingRays most = most_viewing_rays(options);
  refining_.first_spp = std::max(options.spp, sampling.first);
  refining_.most = most;
  if (sampling.is_by_noise())
    refining_.most.in_pixel = refining_.most.in_mean = std::max(most.in_pixel, sampling.most);
  film_.set_evenness(sampling.evenness);
  steps_.first = uint32_t(passes_of(refining_.first_spp));
  // Footprints follow the number of rays that a pixel may come to. A footprint that extends beyond
  // a narrow surface adds an error that further rays do not reduce.
  for (Work& w : work_) w.rays.cone = camera.cone(std::max(options.spp, most.usual));
  if (refining_.most.in_pixel > refining_.first_spp) {
    refining_.records.emplace(plan_.region);
    refining_.has_surrogates = integrator.has_surrogates();
    refining_.outlines.emplace(scene, camera_, plan_.region, refining_.has_surrogates,
                               options.threads);
    if (sampling.is_by_noise()) {
      refining_.options.error = float(sampling.error);
      refining_.options.evenness = sampling.evenness;
      refining_.options.is_everywhere = refining_.options.is_noise = true;
    }
    steps_.further = uint32_t(passes_of(refining_.most.in_pixel - refining_.first_spp));
    if (refining_.has_surrogates) {
      film_.expect_surrogates();
      refining_.options.error = float(options.error);
      refining_.options.is_everywhere = true;
      refining_.options.most_even = 6;
      if (options.indirect != Indirect::none)
        refining_.options.most_effort_divisor = SampleRequest::most_effort_divisor;
      if (options.indirect == Indirect::none)
        refining_.options.least_with_surrogates = options.method.row().refinement * options.spp;
      steps_.surrogates = 1;
    }
    if (refines_at_once()) steps_.further = 1;
  }
  progress_.gaps = size_t(plan_.window.width()) * size_t(plan_.window.height());
  if (options.checkpoint != nullptr && !options.checkpoint->chunks().empty()) restore();
}

void Rendering::set_seconds_per_gap(double seconds_per_pixel) {
  progress_.seconds_per_gap = seconds_per_pixel;
  if (options_.deadline != nullptr)
    options_.deadline->keep_back(double(progress_.gaps) * seconds_per_pixel);
}

RenderEnd Rendering::run() {
  const bool uses_typical_luminance = options_.method.row().uses_typical_luminance;
  const auto typical = uses_typical_luminance ? float(typical_luminance()) : 0;
  for (Work& w : work_) {
    w.rays.request.is_picture = typical > 0;
    w.rays.request.typical_luminance = typical;
  }
  agree_on_limits();
  RenderEnd end = RenderEnd::complete;
  const uint32_t at_a_time = refining_.is_stepwise ? 1 : steps_.first;
  for (uint32_t pass = 0; pass < steps_.first && end == RenderEnd::complete; pass += at_a_time) {
    step({pass, pass + at_a_time}, all_tiles(), [&](uint32_t n, const PixelRect& tile, Work& w) {
      const int first = int(n) * samples_per_batch;
      const auto count = uint32_t(std::min(samples_per_batch, refining_.first_spp - first));
      for (const Pixel2& p : pixels_in_order(tile)) add_rays(p, count, w);
      return trace_all(w);
    });
    if (progress_.was_stopped)
      end = RenderEnd::stopped;
    else if (pass + at_a_time < steps_.all() && is_good_enough(pass + at_a_time - 1, all_tiles()))
      end = RenderEnd::good_enough;
  }
  if (refining_.records && end == RenderEnd::complete) end = refine();
  if (options_.checkpoint != nullptr) save();
  return end;
}

std::vector<Layer> Rendering::layers() const {
  std::vector<Layer> layers = film_.layers();
  for (Layer& l : layers) l.image = part_of(l.image, plan_.region, plan_.window);
  return layers;
}

ViewingErrors Rendering::viewing_errors() const {
  const PixelRect& w = plan_.window;
  ViewingErrors e;
  const double mean = mean_luminance(w);
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

double Rendering::estimated_error() const {
  const PixelRect& w = plan_.window;
  double sum = 0;
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) sum += sqr(film_.estimated_error(x, y));
  const double mean = mean_luminance(w), pixels = double(w.width()) * w.height();
  return mean > 0 ? std::sqrt(sum / pixels) / mean : 0;
}

double Rendering::share_done() const {
  return std::min(
      1.0, double(progress_.tiles_done) / double(book_.size() * (steps_.first + steps_.further)));
}

Counters Rendering::counters() const {
  Counters sum = book_.counters();
  for (const Work& w : work_) sum += w.counters;  // of interrupted tiles
  return sum;
}

std::string Rendering::name_of_ray(const void* work, size_t i) {
  const Work& w = *static_cast<const Work*>(work);
  return "pixel (" + std::to_string(w.pixels[i].x) + "," + std::to_string(w.pixels[i].y) +
         "), sample " + std::to_string(w.rays.samples[i]);
}

// Does these steps for those of the tiles, in this order, that have not done them yet.
void Rendering::step(const StepSpan& steps, const Tiles& tiles, const Act& act) {
  if (options_.group != nullptr) return share_steps(steps, tiles, act);
  for (uint32_t number = steps.first; number < steps.end; ++number) {
    Tiles left;
    for (const size_t t : tiles)
      if (book_.steps(t) == number) left.push_back(t);
    std::atomic<size_t> next = 0;
    parallel_for_slots(left.size(), options_.threads, [&](size_t, size_t slot) {
      do_step(number, left[next.fetch_add(1)], slot, act);
    });
    if (progress_.was_stopped) return;
  }
}

// Returns false if it was stopped.
bool Rendering::do_step(uint32_t number, size_t t, size_t slot, const Act& act) {
  if (stop_.load(std::memory_order_relaxed)) {
    progress_.was_stopped = true;
    return false;
  }
  Work& w = work_[slot];
  if (!w.scratch) w.scratch = integrator_.make_scratch();
  w.rays.clear();
  w.pixels.clear();
  book_.begin(t, slot, [&](std::vector<uint8_t>& out) { save_tile(t, out); });
  if (!act(number, plan_.tiles[t], w)) {
    progress_.was_stopped = true;
    return false;
  }
  // errors thrown by callbacks name a ray
  const CheckContext context(&w, w.rays.size(), name_of_ray);
  book_.finish(slot, w.counters);
  w.counters = {};
  if (!leads()) return true;
  tell_progress(t, number);
  save_in_time();
  return true;
}

// Reports progress. No other thread may work on the tile.
void Rendering::tell_progress(size_t tile, uint32_t step) {
  const PixelRect& r = plan_.tiles[tile];
  if (options_.preview != nullptr) options_.preview->update(film_, r);
  {
    const std::lock_guard lock(progress_.mutex);
    if (step == 0) {
      progress_.gaps -= common_pixels(r, plan_.window);
      set_seconds_per_gap(progress_.seconds_per_gap);
    }
    const bool is_surrogate = step >= steps_.first && step < steps_.first + steps_.surrogates;
    if (!is_surrogate) ++progress_.tiles_done;
    if (report_) report_(share_done());
  }
}

void Rendering::save_in_time() {
  if (options_.checkpoint != nullptr && options_.checkpoint->take_turn()) save();
}

// True if the work may end after a step. later: tiles that would continue.
bool Rendering::is_good_enough(uint32_t step, const Tiles& later) {
  if (!(options_.error_limit > 0)) return false;
  // A tile that has passed this step proves that an earlier check found the error too large.
  bool has_gone_on = false;
  for (const size_t t : later) has_gone_on |= book_.steps(t) > step + 1;
  return agree(leads() && !has_gone_on && estimated_error() <= options_.error_limit);
}

Rendering::Tiles Rendering::all_tiles() const {
  Tiles tiles(plan_.tiles.size());
  std::iota(tiles.begin(), tiles.end(), size_t(0));
  return tiles;
}

// Adds the next `count` viewing rays of a pixel.
void Rendering::add_rays(const Pixel2& p, uint32_t count, Work& w) const {
  add_viewing_rays(camera_, p, film_.estimate(p.x, p.y).samples, count, options_.seed, w.rays);
  w.pixels.resize(w.rays.size(), p);
}

// Traces the collected rays, if any. Always returns true.
bool Rendering::trace_all(Work& w) {
  const CheckContext context(&w, w.rays.size(), name_of_ray);
  if (w.rays.size() > 0) trace(w);
  return true;
}

// Returns the correction of LightOutlines::evened for a ray.
Rgb Rendering::edge_correction(const Work& w, size_t ray) const {
  return refining_.outlines->edge_correction(w.pixels[ray].x, w.pixels[ray].y, w.rays.places[ray],
                                             w.radiance.known[ray].direct);
}

void Rendering::trace(Work& w) {
  w.radiance.reset(w.rays.size());
  if (refining_.records) w.radiance.records.assign(w.rays.size(), {});
  if (refining_.has_surrogates) w.radiance.known.assign(w.rays.size(), {});
  integrator_.radiance(w.rays, *w.scratch, w.radiance, w.counters);
  for (size_t i = 0; i < w.rays.size(); ++i) {
    const auto [x, y] = w.pixels[i];
    if (refining_.has_surrogates) {
      const Rgb even = edge_correction(w, i);
      w.radiance.edge_correction.push_back(even);
      w.radiance.direct[i] += even;
      w.radiance.known[i].direct += even;
    }
    const bool is_first = film_.estimate(x, y).samples == 0;
    const float depth = camera_.depth(w.radiance.position[i]);
    if (!film_.add(x, y, w.radiance, i, depth)) ++w.counters.nan_samples;
    // Only the first pass stores records, since refinement compares with those.
    if (refining_.records && !refining_.has_begun)
      refining_.records->note(x, y, std::move(w.radiance.records[i]), is_first);
  }
}

double Rendering::mean_luminance(const PixelRect& w) const {
  double sum = 0;
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) sum += film_.estimate(x, y).luminance;
  return sum / (double(w.width()) * w.height());
}

}  // namespace troffer
