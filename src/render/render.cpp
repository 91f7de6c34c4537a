#include "render/render.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>
#include <utility>

#include "base/error.h"
#include "base/random.h"
#include "integrate/fixed.h"
#include "integrate/integrator.h"
#include "integrate/path.h"
#include "integrate/purposes.h"
#include "render/camera.h"
#include "render/film.h"

namespace troffer {

namespace {

// Pixels of a tile's side and samples of a pixel per batch: a batch of about a thousand paths is
// long enough for packets and short enough for the second-level cache.
constexpr int widest_tile = 16;
constexpr int samples_per_batch = 4;
// Stops are looked for between tiles: those of scenes with many sources are smaller.
constexpr double most_shadow_rays_per_tile = 1 << 22;

// Larger pictures are refused before memory is: machines that promise more than they have would end
// the program without a word.
constexpr double most_film_bytes = 8.0 * (1 << 30);

struct TileWork {
  ViewingRays rays;
  RadianceBatch radiance;
  std::vector<std::pair<int, int>> pixels;  // of each ray
  std::unique_ptr<IntegratorScratch> scratch;
  Counters counters;
};

std::unique_ptr<Integrator> make_integrator(const PreparedScene& scene, const RenderOptions& o) {
  if (o.method == Method::fixed)
    return std::make_unique<FixedIntegrator>(scene, FixedOptions{o.shadow_rays});
  PathOptions path;
  path.depth = o.depth;
  path.is_direct_only = o.indirect == Indirect::none;
  return std::make_unique<PathIntegrator>(scene, path);
}

int tile_side(const RenderOptions& o, size_t emitters) {
  if (o.method != Method::fixed) return widest_tile;
  const double per_pixel = double(samples_per_batch) * o.shadow_rays * double(emitters);
  int side = widest_tile;
  while (side > 1 && per_pixel * side * side > most_shadow_rays_per_tile) side /= 2;
  return side;
}

std::vector<PixelRect> tiles_of(const PixelRect& window, int side) {
  std::vector<PixelRect> tiles;
  for (int y = window.y0; y < window.y1; y += side)
    for (int x = window.x0; x < window.x1; x += side)
      tiles.push_back({x, y, std::min(x + side, window.x1), std::min(y + side, window.y1)});
  return tiles;
}

void viewing_rays(const ViewingCamera& camera, const PixelRect& tile, int first_sample, int samples,
                  uint64_t seed, TileWork& work) {
  work.rays.clear();
  work.pixels.clear();
  for (int y = tile.y0; y < tile.y1; ++y)
    for (int x = tile.x0; x < tile.x1; ++x) {
      const uint64_t stream = hash_of(seed, uint64_t(x), uint64_t(y));
      for (int s = first_sample; s < first_sample + samples; ++s) {
        const SobolGroup random(stream, purpose_camera, uint32_t(s));
        const Vec2 raster = Vec2{float(x), float(y)} + random.get2(0);  // box filter
        work.rays.rays.push_back(camera.ray(raster, random.get2(2)));
        work.rays.streams.push_back(stream);
        work.rays.samples.push_back(uint32_t(s));
        work.pixels.emplace_back(x, y);
      }
    }
}

PixelRect window_of(const RenderOptions& o, int width, int height) {
  if (!o.has_crop) return {0, 0, width, height};
  const PixelRect w{o.crop[0], o.crop[1], o.crop[2], o.crop[3]};
  if (w.x0 < 0 || w.y0 < 0 || w.x1 > width || w.y1 > height || w.x0 >= w.x1 || w.y0 >= w.y1)
    throw UsageError("--crop is empty or reaches outside the image of " + std::to_string(width) +
                     "x" + std::to_string(height) + " pixels");
  return w;
}

// InputError where the camera's numbers overflow: a place or a lens beyond measure.
void check_camera(const ViewingCamera& camera, const PixelRect& window, const PreparedScene& scene,
                  const std::string& name) {
  for (const int x : {window.x0, window.x1})
    for (const int y : {window.y0, window.y1})
      for (const float lens : {0.0f, 0.5f, 1.0f}) {
        const Ray r = camera.ray({float(x), float(y)}, {lens, 0.5f});
        if (!(length(abs(r.origin)) < 1e15f) || !is_finite(r.direction))
          throw InputError(scene.scene.file, 0, 0,
                           "camera '" + name +
                               "' cannot be used: it is too far away, or its field "
                               "of view or lens is beyond measure");
      }
}

}  // namespace

RenderResult render(const PreparedScene& scene, const Camera& camera, const RenderOptions& options,
                    const ProgressCallback& progress, const StopFlag& stop) {
  const auto start = std::chrono::steady_clock::now();
  const ImageSize size = image_size(camera, options.width, options.height);
  const PixelRect window = window_of(options, size.width, size.height);
  if (Film::bytes(double(window.width()) * window.height(), options.aovs) > most_film_bytes)
    throw UsageError("an image of " + std::to_string(window.width()) + "x" +
                     std::to_string(window.height()) +
                     " pixels with these layers takes more than 8 GiB: use --size or --crop");
  const ViewingCamera viewing_camera(camera, size.width, size.height);
  check_camera(viewing_camera, window, scene, camera.name);
  const std::unique_ptr<Integrator> integrator = make_integrator(scene, options);
  const std::vector<PixelRect> tiles =
      tiles_of(window, tile_side(options, scene.scene.emitters.size()));
  Film film(window, options.aovs);

  const int passes = (options.spp + samples_per_batch - 1) / samples_per_batch;
  std::vector<TileWork> work(size_t(thread_count(options.threads)));
  std::mutex progress_mutex;
  size_t tiles_done = 0;
  std::atomic<bool> was_stopped = false;

  for (int pass = 0; pass < passes && !was_stopped; ++pass) {
    const int first = pass * samples_per_batch;
    const int samples = std::min(samples_per_batch, options.spp - first);
    parallel_for_slots(tiles.size(), options.threads, [&](size_t t, size_t slot) {
      if (stop.load(std::memory_order_relaxed)) {
        was_stopped = true;
        return;
      }
      TileWork& w = work[slot];
      if (!w.scratch) w.scratch = integrator->make_scratch();
      const CheckContext context(tiles[t].x0, tiles[t].y0, first);
      viewing_rays(viewing_camera, tiles[t], first, samples, options.seed, w);
      w.radiance.reset(w.rays.size());
      integrator->radiance(w.rays, *w.scratch, w.radiance, w.counters);
      for (size_t i = 0; i < w.rays.size(); ++i) {
        const auto [x, y] = w.pixels[i];
        const float depth = viewing_camera.depth(w.radiance.position[i]);
        if (!film.add(x, y, w.radiance, i, depth)) ++w.counters.nan_samples;
      }
      const std::lock_guard lock(progress_mutex);
      ++tiles_done;
      if (progress) progress(double(tiles_done) / (double(tiles.size()) * passes));
    });
  }

  RenderResult result;
  result.is_complete = !was_stopped;
  result.layers = film.layers();
  result.statistics.width = window.width();
  result.statistics.height = window.height();
  for (const TileWork& w : work) result.statistics.counters += w.counters;
  result.statistics.render_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace troffer
