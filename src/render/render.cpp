#include "render/render.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>

#include "base/error.h"
#include "integrate/certified.h"
#include "integrate/fixed.h"
#include "integrate/integrator.h"
#include "integrate/kj92.h"
#include "integrate/path.h"
#include "render/camera.h"
#include "render/film.h"
#include "render/refinement.h"
#include "render/tile.h"

namespace troffer {

namespace {

// Pixels of a tile's side and samples of a pixel per batch: a batch of about a thousand paths is
// long enough for packets and short enough for the second-level cache.
constexpr int widest_tile = 16;
constexpr int samples_per_batch = 4;
// Stops are looked for between tiles: those of scenes with many sources are smaller.
constexpr double most_shadow_rays_per_tile = 1 << 22;
// certified: clusters of hits should be small in space, and few sources get rays.
constexpr int certified_tile = 8;
constexpr double most_certified_rays_per_tile = 1 << 25;

// Larger pictures are refused before memory is: machines that promise more than they have would end
// the program without a word.
constexpr double most_film_bytes = 8.0 * (1 << 30);

std::unique_ptr<Integrator> make_integrator(const PreparedScene& scene, const RenderOptions& o,
                                            const Kj92Preparation* preparation) {
  if (o.method == Method::fixed)
    return std::make_unique<FixedIntegrator>(scene, FixedOptions{o.shadow_rays});
  if (o.method == Method::kj92)
    return std::make_unique<Kj92Integrator>(
        scene, preparation->solution, preparation->selection,
        Kj92Options{o.kj92.sampling, o.indirect == Indirect::none});
  if (o.method == Method::certified)
    return make_certified(scene, o.error, o.indirect == Indirect::none ? nullptr : preparation);
  PathOptions path;
  path.depth = o.depth;
  path.is_direct_only = o.indirect == Indirect::none;
  return std::make_unique<PathIntegrator>(scene, path);
}

int tile_side(const RenderOptions& o, size_t lights) {
  const bool is_certified = o.method == Method::certified;
  if (o.method != Method::fixed && !is_certified) return widest_tile;
  const int rays = is_certified ? certified_settings(o.error, lights).shadow_rays : o.shadow_rays;
  const double most = is_certified ? most_certified_rays_per_tile : most_shadow_rays_per_tile;
  const double per_pixel = double(samples_per_batch) * rays * double(lights);
  int side = is_certified ? certified_tile : widest_tile;
  while (side > 1 && per_pixel * side * side > most) side /= 2;
  return side;
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

double film_bytes(const PixelRect& window, const RenderOptions& o) {
  const double pixels = double(window.width()) * window.height();
  constexpr double record = sizeof(ShadowRecord) + 4 * sizeof(SourcePattern);
  return Film::bytes(pixels, o.aovs) + (most_viewing_rays(o) > o.spp ? pixels * record : 0);
}

// One picture under way.
class Rendering {
 public:
  // `image`: all of it, of which `window` is wanted.
  Rendering(const PreparedScene& scene, const ViewingCamera& camera, const Integrator& integrator,
            const RenderOptions& options, const PixelRect& window, const PixelRect& image,
            const ProgressCallback& progress, const StopFlag& stop)
      : camera_(camera),
        integrator_(integrator),
        options_(options),
        max_spp_(most_viewing_rays(options)),
        is_refined_(max_spp_ > options.spp),
        image_(image),
        window_(window),
        side_(tile_side(options, scene.scene.lights.size())),
        region_(is_same_in_crops() ? whole_tiles(window, side_, is_refined_ ? 1 : 0, image)
                                   : window),
        tiles_(tiles_of(region_, side_)),
        film_(region_, options.aovs),
        work_(size_t(thread_count(options.threads))),
        progress_(progress),
        stop_(stop),
        passes_(passes_of(options.spp) + passes_of(max_spp_ - options.spp)) {
    if (is_refined_) records_.emplace(region_);
  }

  bool run() {
    for (int first = 0; first < options_.spp && !was_stopped_; first += samples_per_batch) {
      const int count = std::min(samples_per_batch, options_.spp - first);
      pass([&](const PixelRect& tile, Work& w) {
        for (const Pixel2& p : pixels_in_order(tile)) w.add(*this, p, uint32_t(count));
      });
    }
    if (is_refined_ && !was_stopped_) refine();
    return !was_stopped_;
  }

  std::vector<Layer> layers() const {
    std::vector<Layer> layers = film_.layers();
    for (Layer& l : layers) l.image = part_of(l.image, region_, window_);
    return layers;
  }
  Counters counters() const {
    Counters sum;
    for (const Work& w : work_) sum += w.counters;
    return sum;
  }

 private:
  // Memory of one thread.
  struct Work {
    ViewingRays rays;
    RadianceBatch radiance;
    std::vector<Pixel2> pixels;  // of each ray
    std::unique_ptr<IntegratorScratch> scratch;
    Counters counters;

    // The next `count` viewing rays of a pixel.
    void add(const Rendering& r, const Pixel2& p, uint32_t count) {
      add_viewing_rays(r.camera_, p, r.film_.estimate(p.x, p.y).samples, count, r.options_.seed,
                       rays);
      pixels.resize(rays.size(), p);
    }
  };

  static std::string name_of_ray(const void* work, size_t i) {
    const Work& w = *static_cast<const Work*>(work);
    return "pixel (" + std::to_string(w.pixels[i].x) + "," + std::to_string(w.pixels[i].y) +
           "), sample " + std::to_string(w.rays.samples[i]);
  }

  static int passes_of(int samples) {
    return (samples + samples_per_batch - 1) / samples_per_batch;
  }

  // A method whose noise depends on what else is in a batch gives a pixel of a crop the value it
  // has in the whole picture if batches are the same: whole tiles of the picture, and a ring of
  // tiles around them where neighbours decide about refinement. kj92 does not, as its results are
  // compared with published ones of the very crop.
  bool is_same_in_crops() const { return options_.method == Method::certified; }

  // fill(tile, work) says which rays are traced; they are, and added to the film.
  template <class Fill>
  void pass(Fill&& fill) {
    parallel_for_slots(tiles_.size(), options_.threads, [&](size_t t, size_t slot) {
      if (stop_.load(std::memory_order_relaxed)) {
        was_stopped_ = true;
        return;
      }
      Work& w = work_[slot];
      if (!w.scratch) w.scratch = integrator_.make_scratch();
      w.rays.clear();
      w.pixels.clear();
      fill(tiles_[t], w);
      const CheckContext context(&w, w.rays.size(), name_of_ray);
      if (w.rays.size() > 0) trace(w);
      const std::lock_guard lock(progress_mutex_);
      ++tiles_done_;
      if (progress_)
        progress_(std::min(1.0, double(tiles_done_) / (double(tiles_.size()) * passes_)));
    });
  }

  void trace(Work& w) {
    w.radiance.reset(w.rays.size());
    if (is_refined_) w.radiance.records.assign(w.rays.size(), {});
    integrator_.radiance(w.rays, *w.scratch, w.radiance, w.counters);
    for (size_t i = 0; i < w.rays.size(); ++i) {
      const auto [x, y] = w.pixels[i];
      const bool is_first = film_.estimate(x, y).samples == 0;
      const float depth = camera_.depth(w.radiance.position[i]);
      if (!film_.add(x, y, w.radiance, i, depth)) ++w.counters.nan_samples;
      // Refinement compares with what the first pass saw, and does not change it.
      if (is_refined_ && !is_refining_)
        records_->note(x, y, std::move(w.radiance.records[i]), is_first);
    }
  }

  // Rounds of further rays; each looks at what there was before it, in all of the picture.
  void refine() {
    const double mean = is_same_in_crops() ? typical_luminance() : mean_luminance();
    const PixelRect inner = is_same_in_crops() ? whole_tiles(window_, side_, 0, image_) : window_;
    std::vector<uint8_t> is_wanted(size_t(region_.width()) * size_t(region_.height()));
    for (int y = inner.y0; y < inner.y1; ++y)
      for (int x = inner.x0; x < inner.x1; ++x)
        is_wanted[records_->index(x, y)] =
            needs_refinement(film_, *records_, x, y, mean, refinement_) ? 1 : 0;
    is_refining_ = true;
    for (int first = options_.spp; first < max_spp_ && !was_stopped_; first += samples_per_batch) {
      const auto count = uint32_t(std::min(samples_per_batch, max_spp_ - first));
      pass([&](const PixelRect& tile, Work& w) {
        for (const Pixel2& p : pixels_in_order(tile)) {
          if (is_wanted[records_->index(p.x, p.y)] == 0) continue;
          const PixelEstimate e = film_.estimate(p.x, p.y);
          // A spread is only worth believing from several samples.
          if (first > options_.spp && e.samples >= 4 && !needs_more(e, mean, refinement_)) continue;
          w.add(*this, p, count);
          w.rays.neighbours.resize(w.rays.size(), records_->around(p.x, p.y));
        }
      });
    }
  }

  // Mean luminance of the whole picture but its brightest twentieth (lamps), from few rays, which
  // are no part of the picture and of its statistics.
  double typical_luminance() {
    constexpr int most = 32;  // rays along each side
    Work& w = work_[0];
    if (!w.scratch) w.scratch = integrator_.make_scratch();
    w.rays.clear();
    w.pixels.clear();
    const int nx = std::min(most, image_.width()), ny = std::min(most, image_.height());
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        w.pixels.push_back({i * image_.width() / nx, j * image_.height() / ny});
        add_viewing_rays(camera_, w.pixels.back(), 0, 1, options_.seed, w.rays);
      }
    const CheckContext context(&w, w.rays.size(), name_of_ray);
    w.radiance.reset(w.rays.size());
    Counters uncounted;
    integrator_.radiance(w.rays, *w.scratch, w.radiance, uncounted);
    std::vector<double> values;
    for (size_t i = 0; i < w.rays.size(); ++i) {
      const Rgb l = w.radiance.direct[i] + w.radiance.indirect[i];
      values.push_back(is_finite(l) ? double(luminance(l)) : 0);
    }
    std::sort(values.begin(), values.end());
    values.resize(values.size() - values.size() / 20);
    return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
  }

  double mean_luminance() const {
    double sum = 0;
    for (int y = window_.y0; y < window_.y1; ++y)
      for (int x = window_.x0; x < window_.x1; ++x) sum += film_.estimate(x, y).luminance;
    return sum / (double(window_.width()) * window_.height());
  }

  const ViewingCamera camera_;
  const Integrator& integrator_;
  const RenderOptions& options_;
  int max_spp_;
  bool is_refined_, is_refining_ = false;
  PixelRect image_, window_;
  int side_;          // of tiles
  PixelRect region_;  // what is rendered: the window, and what it takes for it to be as it should
  std::vector<PixelRect> tiles_;
  Film film_;
  std::vector<Work> work_;
  const ProgressCallback& progress_;
  const StopFlag& stop_;
  RefinementOptions refinement_;
  std::optional<PixelRecords> records_;
  int passes_;
  std::mutex progress_mutex_;
  size_t tiles_done_ = 0;
  std::atomic<bool> was_stopped_ = false;
};

}  // namespace

int most_viewing_rays(const RenderOptions& options) {
  if (options.method != Method::kj92 && options.method != Method::certified) return options.spp;
  if (options.max_spp > 0) return std::max(options.max_spp, options.spp);
  constexpr int certified_refinement = 4;
  return options.method == Method::certified ? certified_refinement * options.spp : options.spp;
}

void check_options(const PreparedScene& scene, const Camera& camera, const RenderOptions& options) {
  const ImageSize size = image_size(camera, options.width, options.height);
  const PixelRect window = window_of(options, size.width, size.height);
  if (film_bytes(window, options) > most_film_bytes)
    throw UsageError("an image of " + std::to_string(window.width()) + "x" +
                     std::to_string(window.height()) +
                     " pixels with these layers takes more than 8 GiB: use --size or --crop");
  check_camera(ViewingCamera(camera, size.width, size.height), window, scene, camera.name);
}

bool needs_preparation(Method method, Indirect indirect) {
  return method == Method::kj92 || (method == Method::certified && indirect != Indirect::none);
}

std::unique_ptr<Kj92Preparation> prepare(const PreparedScene& scene, Method method,
                                         const Kj92Settings& settings, Indirect indirect,
                                         std::optional<RadiositySolution> solution, int threads,
                                         const ProgressCallback& progress, const StopFlag& stop) {
  if (!needs_preparation(method, indirect)) return nullptr;
  Kj92Settings s = settings;
  if (method == Method::certified) s.selection = certified_selection(s.selection.is_enabled);
  return prepare_kj92(scene, s, indirect == Indirect::none, std::move(solution), threads, progress,
                      stop);
}

std::unique_ptr<Integrator> make_certified(const PreparedScene& scene, double error,
                                           const Kj92Preparation* preparation) {
  std::optional<RadiosityLight> radiosity;
  if (preparation != nullptr)
    radiosity.emplace(scene, preparation->solution, preparation->selection);
  return std::make_unique<CertifiedIntegrator>(
      scene, radiosity, certified_settings(error, scene.scene.lights.size()));
}

RenderResult render(const PreparedScene& scene, const Camera& camera, const RenderOptions& options,
                    const ProgressCallback& progress, const StopFlag& stop) {
  check_options(scene, camera, options);
  const ImageSize size = image_size(camera, options.width, options.height);
  const PixelRect image{0, 0, size.width, size.height};
  const PixelRect window = window_of(options, size.width, size.height);
  RenderResult result;
  result.statistics.width = window.width();
  result.statistics.height = window.height();

  const Kj92Preparation* preparation = options.preparation;
  std::unique_ptr<Kj92Preparation> own;
  const bool is_prepared = needs_preparation(options.method, options.indirect);
  if (is_prepared && preparation == nullptr) {
    own = prepare(scene, options.method, options.kj92, options.indirect, std::nullopt,
                  options.threads, nullptr, stop);
    preparation = own.get();
  }
  if (is_prepared && preparation == nullptr) {  // stopped: nothing to show
    result.is_complete = false;
    result.layers = Film(window, options.aovs).layers();
    return result;
  }
  if (preparation != nullptr) result.statistics.preprocess_seconds = preparation->seconds;

  const auto start = std::chrono::steady_clock::now();
  const std::unique_ptr<Integrator> integrator = make_integrator(scene, options, preparation);
  Rendering rendering(scene, ViewingCamera(camera, size.width, size.height), *integrator, options,
                      window, image, progress, stop);
  result.is_complete = rendering.run();
  result.layers = rendering.layers();
  result.statistics.counters = rendering.counters();
  result.statistics.render_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace troffer
