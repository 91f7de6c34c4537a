#include "render/render.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>

#include "base/error.h"
#include "render/camera.h"
#include "render/cell_pilot.h"
#include "render/film.h"
#include "render/rendering.h"
#include "render/tile.h"

namespace troffer {

namespace {

// Larger pictures are refused before memory is: machines that promise more than they have would end
// the program without a word.
constexpr double most_film_bytes = 8.0 * (1 << 30);

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

// Small enough that a tile does not take too many shadow rays.
int tile_side(Method method, const MethodSettings& settings, size_t lights) {
  const MethodRow& row = method.row();
  const double per_pixel = samples_per_batch * row.rays_per_sample(settings, lights);
  int side = row.widest_tile;
  while (side > 1 && per_pixel * side * side > row.most_rays_per_tile) side /= 2;
  return side;
}

// Progress from `first` to `last` of the whole.
ProgressCallback part_of_progress(const ProgressCallback& progress, double first, double last) {
  if (!progress) return nullptr;
  return [&progress, first, last](double f) { progress(first + (last - first) * f); };
}

PixelWindow pixels_of(const PixelRect& r) {
  return {r.x0, r.y0, r.x1, r.y1};
}

// Stopped before there was anything to show.
RenderResult nothing_rendered(const PixelRect& window, const RenderOptions& options,
                              RenderResult result) {
  result.is_complete = false;
  result.layers = Film(window, options.aovs).layers();
  return result;
}

double film_bytes(const PixelRect& window, const RenderOptions& o) {
  const double pixels = double(window.width()) * window.height();
  constexpr double corner = 32;  // EdgeMap
  constexpr double record = sizeof(ShadowRecord) + 4 * sizeof(SourcePattern) + corner + sizeof(int);
  const bool is_refined = most_viewing_rays(o) > o.spp;
  const bool has_glances = is_refined && needs_cells(o.method, o.indirect);
  return Film::bytes(pixels, o.aovs, has_glances) + (is_refined ? pixels * record : 0);
}

}  // namespace

int most_viewing_rays(const RenderOptions& options) {
  if (options.max_spp > 0) return std::max(options.max_spp, options.spp);
  // By what cells know, edges cost little, and further rays are for what is left.
  constexpr int with_cells = 16;
  const MethodRow& row = options.method.row();
  if (row.refinement > 1 && needs_cells(options.method, options.indirect))
    return with_cells * options.spp;
  return row.refinement * options.spp;
}

MethodSettings method_settings(const RenderOptions& o) {
  MethodSettings s;
  s.indirect = o.indirect;
  s.shadow_rays = o.shadow_rays;
  s.error = o.error;
  s.viewing_rays = o.spp;
  s.most_viewing_rays = o.max_spp > 0 ? std::max(o.max_spp, o.spp) : 0;
  s.trees = o.kj92.sampling;
  s.depth = o.depth;
  s.threads = o.threads;
  return s;
}

void check_options(const PreparedScene& scene, const Camera& camera, const RenderOptions& options) {
  const ImageSize size = image_size(camera, options.width, options.height);
  const PixelRect window = wanted_window(options, size.width, size.height);
  if (film_bytes(window, options) > most_film_bytes)
    throw UsageError("an image of " + std::to_string(window.width()) + "x" +
                     std::to_string(window.height()) +
                     " pixels with these layers takes more than 8 GiB: use --size or --crop");
  check_camera(ViewingCamera(camera, size.width, size.height), window, scene, camera.name);
}

RenderResult render(const PreparedScene& scene, const Camera& camera, const RenderOptions& options,
                    const ProgressCallback& progress, const StopFlag& stop) {
  check_options(scene, camera, options);
  const ImageSize size = image_size(camera, options.width, options.height);
  const PixelRect image{0, 0, size.width, size.height};
  const PixelRect window = wanted_window(options, size.width, size.height);
  RenderResult result;
  result.statistics.width = window.width();
  result.statistics.height = window.height();

  const Preparation* preparation = options.preparation;
  std::unique_ptr<Preparation> own;
  const bool is_prepared = needs_radiosity(options.method, options.indirect);
  if (is_prepared && preparation == nullptr) {
    own = prepare(scene, options.method, options.kj92, options.indirect, std::nullopt,
                  options.threads, nullptr, stop);
    preparation = own.get();
  }
  if (is_prepared && preparation == nullptr) {  // stopped: nothing to show
    return nothing_rendered(window, options, result);
  }
  if (preparation != nullptr) result.statistics.preprocess_seconds = preparation->seconds;

  const auto start = std::chrono::steady_clock::now();
  const MethodSettings settings = method_settings(options);
  const MethodRow& row = options.method.row();
  const bool is_refined = most_viewing_rays(options) > options.spp;
  const bool has_whole_tiles = row.is_same_in_crops && (row.has_noise_of_batch || is_refined);
  const int side = tile_side(options.method, settings, scene.scene.lights.size());
  const TilePlan plan = plan_tiles(image, window, side, has_whole_tiles, is_refined);
  const ViewingCamera viewing(camera, size.width, size.height);
  const PictureView view{pixels_of(image), pixels_of(plan.region), [&](float x, float y) {
                           return viewing.ray({x, y}, {0.5f, 0.5f});
                         }};
  // Cells and their gathers take about as long as what follows.
  const double share = needs_cells(options.method, options.indirect) ? 0.5 : 0.0;
  const ProgressCallback of_cells = part_of_progress(progress, 0, share),
                         of_tiles = part_of_progress(progress, share, 1);
  CellInput cells{picture_pilot(viewing, size, options.seed),
                  &view,
                  options.seed,
                  of_cells,
                  stop,
                  {},
                  {},
                  options.cells};
  const std::unique_ptr<Integrator> integrator =
      make_integrator(scene, options.method, settings, preparation, &cells);
  if (!integrator) return nothing_rendered(window, options, result);
  result.statistics.cells = cells.statistics;
  result.statistics.is_by_paths = integrator->sampling().is_by_noise();
  Rendering rendering(scene, viewing, *integrator, options, plan, of_tiles, stop);
  result.is_complete = rendering.run();
  result.layers = rendering.layers();
  result.statistics.counters = rendering.counters();
  result.statistics.viewing_errors = rendering.viewing_errors();
  result.statistics.render_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace troffer
