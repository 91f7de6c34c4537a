#include "render/gap_filler.h"

#include <algorithm>
#include <chrono>

#include "base/random.h"
#include "base/streams.h"

namespace troffer {

namespace {

constexpr uint32_t samples_at_once = 4;
constexpr uint32_t most_samples = 256;
constexpr size_t pixels_of_batch = 256;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

std::unique_ptr<Integrator> paths_for(const PreparedScene& scene, const RenderOptions& options) {
  MethodSettings settings = method_settings(options);
  const bool is_direct = options.method.row().is_direct_only || options.indirect == Indirect::none;
  settings.indirect = Indirect::automatic;
  if (options.method != Method::path) settings.depth = is_direct ? 1 : -1;
  return make_integrator(scene, Method::path, settings, nullptr, nullptr);
}

GapFiller::GapFiller(const PreparedScene& scene, const ViewingCamera& camera,
                     const RenderOptions& options)
    : camera_(camera),
      options_(options),
      integrator_(paths_for(scene, options)),
      work_(size_t(thread_count(options.threads))) {
  for (Work& w : work_) w.rays.cone = camera.cone(int(samples_at_once));
}

std::unique_ptr<Integrator> GapFiller::use(std::unique_ptr<Integrator> other, bool is_by_paths) {
  std::swap(integrator_, other);
  is_by_paths_ = is_by_paths;
  for (Work& w : work_) w.scratch.reset();
  return other;
}

// Traces samples first_sample … first_sample + 3 of each pixel. film: null to discard them.
void GapFiller::trace(const std::vector<Pixel2>& pixels, uint32_t first_sample, Film* film,
                      const StopFlag& stop) {
  // independent of the picture's own samples
  const uint64_t seed = hash_of(options_.seed, stream::gap_filler);
  const size_t batches = (pixels.size() + pixels_of_batch - 1) / pixels_of_batch;
  parallel_for_slots(batches, options_.threads, [&](size_t b, size_t slot) {
    if (stop.load(std::memory_order_relaxed)) return;
    Work& w = work_[slot];
    if (!w.scratch) w.scratch = integrator_->make_scratch();
    w.rays.clear();
    const size_t first = b * pixels_of_batch;
    const size_t end = std::min(first + pixels_of_batch, pixels.size());
    for (size_t p = first; p < end; ++p)
      add_viewing_rays(camera_, pixels[p], first_sample, samples_at_once, seed, w.rays);
    w.radiance.reset(w.rays.size());
    w.radiance.known.assign(w.rays.size(), {});
    integrator_->radiance(w.rays, *w.scratch, w.radiance, w.counters);
    if (film == nullptr) return;
    for (size_t i = 0; i < w.rays.size(); ++i) {
      const Pixel2& p = pixels[first + i / samples_at_once];
      film->add(p.x, p.y, w.radiance, i, camera_.depth(w.radiance.position[i]));
    }
  });
}

double GapFiller::seconds_per_pixel(const PixelRect& window) {
  constexpr int along_each_side = 24;
  const int nx = std::min(along_each_side, window.width()),
            ny = std::min(along_each_side, window.height());
  std::vector<Pixel2> pixels;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
      pixels.push_back({window.x0 + i * window.width() / nx, window.y0 + j * window.height() / ny});
  const StopFlag never = false;
  trace(pixels, 0, nullptr, never);  // warm-up: the first run takes longer
  const auto start = std::chrono::steady_clock::now();
  trace(pixels, samples_at_once, nullptr, never);
  return seconds_since(start) / double(pixels.size());
}

size_t GapFiller::fill(Film& film, const PixelRect& window, const Deadline& deadline) {
  std::vector<Pixel2> gaps;
  for (int y = window.y0; y < window.y1; ++y)
    for (int x = window.x0; x < window.x1; ++x)
      if (film.estimate(x, y).samples == 0) gaps.push_back({x, y});
  if (gaps.empty()) return 0;
  for (uint32_t first = 0; first < most_samples; first += samples_at_once) {
    const auto start = std::chrono::steady_clock::now();
    trace(gaps, first, &film, deadline.parent());
    if (deadline.parent().load() || deadline.seconds_left() < seconds_since(start)) break;
  }
  return gaps.size();
}

}  // namespace troffer
