#include "render/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>

#include "base/deadline.h"
#include "base/error.h"
#include "render/camera.h"
#include "render/cell_pilot.h"
#include "render/checkpoint.h"
#include "render/film.h"
#include "render/gap_filler.h"
#include "render/preview.h"
#include "render/rendering.h"
#include "render/tile.h"

namespace troffer {

namespace {

// Larger pictures are refused up front: on systems that overcommit memory, the program would be
// killed without a message.
constexpr double most_film_bytes = 8.0 * (1 << 30);

// Throws InputError if the camera's numbers overflow.
void check_camera(const ViewingCamera& camera, const PixelRect& window, const PreparedScene& scene,
                  const std::string& name) {
  for (const int x : {window.x0, window.x1})
    for (const int y : {window.y0, window.y1})
      for (const float lens : {0.0f, 0.5f, 1.0f}) {
        const Ray r = camera.ray({float(x), float(y)}, {lens, 0.5f});
        if (!(length(abs(r.origin)) < 1e15f) || !is_finite(r.direction))
          throw InputError(scene.scene.file, 0, 0,
                           "camera '" + name +
                               "' cannot be used: it is too far away, or its field of view or lens "
                               "is out of range");
      }
}

// Returns a tile size at which a tile does not need too many shadow rays.
int tile_side(Method method, const MethodSettings& settings, size_t lights) {
  const MethodRow& row = method.row();
  const double per_pixel = samples_per_pass * row.rays_per_sample(settings, lights);
  int side = row.widest_tile;
  while (side > 1 && per_pixel * side * side > row.most_rays_per_tile) side /= 2;
  return side;
}

// Maps progress to the part from `first` to `last` of the whole.
ProgressCallback part_of_progress(const ProgressCallback& progress, double first, double last) {
  if (!progress) return nullptr;
  return [&progress, first, last](double f) { progress(first + (last - first) * f); };
}

PixelWindow pixels_of(const PixelRect& r) {
  return {r.x0, r.y0, r.x1, r.y1};
}

double film_bytes(const PixelRect& window, const RenderOptions& o) {
  const double pixels = double(window.width()) * window.height();
  constexpr double corner = 32;  // EdgeMap
  constexpr double record = sizeof(ShadowRecord) + 4 * sizeof(SourcePattern) + corner + sizeof(int);
  const bool is_refined = most_viewing_rays(o).in_pixel > o.spp;
  const bool has_surrogates = is_refined && o.method == Method::certified;
  return Film::bytes(pixels, o.aovs, has_surrogates) + (is_refined ? pixels * record : 0);
}

TileRules tile_rules(const PreparedScene& scene, const RenderOptions& o) {
  const MethodRow& row = o.method.row();
  TileRules rules;
  rules.side = tile_side(o.method, method_settings(o), scene.scene.lights.size());
  rules.is_refined = most_viewing_rays(o).in_pixel > o.spp;
  rules.has_whole_tiles = row.is_same_in_crops && (row.has_noise_of_batch || rules.is_refined);
  rules.looks_at_all = !row.is_same_in_crops;
  return rules;
}

TilePlan plan_of(const PreparedScene& scene, const ImageSize& size, const RenderOptions& o) {
  const TileRules rules = tile_rules(scene, o);
  const PixelRect asked = wanted_window(o, size.width, size.height);
  return plan_tiles({0, 0, size.width, size.height}, asked, share_of(asked, rules, o.part, o.parts),
                    rules);
}

// One call of render(): scene and options in, picture out.
class Picture {
 public:
  Picture(const PreparedScene& scene, const Camera& camera, const RenderOptions& options,
          const ProgressCallback& progress, const StopFlag& stop)
      : scene_(scene),
        options_(options),
        progress_(progress),
        stop_(stop),
        size_(image_size(camera, options.width, options.height)),
        plan_(plan_of(scene, size_, options)),
        viewing_(camera, size_.width, size_.height) {
    if (options.deadline == nullptr) return;
    filler_ = std::make_unique<GapFiller>(scene, viewing_, options);
    keep_time_for_gaps();
  }

  RenderResult make();

 private:
  void render(const Preparation* preparation, RenderResult& result);
  void finish(Film& film, RenderResult& result);
  void show_preview_in_gaps(const Film& film, RenderResult& result) const;
  void keep_beginning() const;
  void keep_time_for_gaps();
  void fill_gaps_by(std::unique_ptr<Integrator> quick, double unresolved);
  PlannedPart planned_viewing_rays(const MethodPlan& plan, const MethodSettings& settings) const;

  const PreparedScene& scene_;
  const RenderOptions& options_;
  const ProgressCallback& progress_;
  const StopFlag& stop_;
  const ImageSize size_;
  const TilePlan plan_;
  const ViewingCamera viewing_;
  std::unique_ptr<GapFiller> filler_;  // null if there is no deadline
  double seconds_per_gap_ = 0;
  double missing_light_ = 0;  // share of reflected light that cells cut short do not have
};

// Reserves the time to fill all pixels.
void Picture::keep_time_for_gaps() {
  seconds_per_gap_ = filler_->seconds_per_pixel(plan_.window);
  options_.deadline->keep_back(seconds_per_gap_ * plan_.window.width() * plan_.window.height());
}

RenderResult Picture::make() {
  RenderResult result;
  const PixelRect& window = plan_.window;
  result.window = {window.x0, window.y0, window.x1, window.y1};
  result.statistics.width = window.width();
  result.statistics.height = window.height();
  const Preparation* preparation = options_.preparation;
  std::unique_ptr<Preparation> own;
  const bool is_prepared = needs_radiosity(options_.method, options_.indirect);
  if (is_prepared && preparation == nullptr) {
    own = prepare(scene_, options_.method, options_.kj92, options_.indirect, std::nullopt,
                  options_.threads, nullptr, stop_);
    preparation = own.get();
  }
  if (preparation != nullptr) result.statistics.preprocess_seconds = preparation->seconds;
  const auto start = std::chrono::steady_clock::now();
  result.end = RenderEnd::stopped;
  if (!is_prepared || preparation != nullptr) render(preparation, result);
  if (result.layers.empty()) {  // stopped before there was anything to show
    keep_beginning();
    Film film(plan_.region, options_.aovs, scene_.scene.origin);
    finish(film, result);
    result.statistics.estimated_error = std::hypot(picture_error(film, window), missing_light_);
    result.layers = film.layers();
    for (Layer& l : result.layers) l.image = part_of(l.image, plan_.region, window);
    show_preview_in_gaps(film, result);
  }
  result.is_complete = result.end == RenderEnd::complete || result.end == RenderEnd::good_enough;
  result.statistics.render_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

// Writes an empty checkpoint if a rendering is stopped early, unless an earlier one exists.
void Picture::keep_beginning() const {
  if (options_.checkpoint != nullptr && options_.checkpoint->chunks().empty())
    options_.checkpoint->write([](const Checkpoint::Add&) {});
}

// Fills the gaps of a picture whose deadline is over.
void Picture::finish(Film& film, RenderResult& result) {
  if (result.end != RenderEnd::stopped || !filler_ || !options_.deadline->is_over()) return;
  result.statistics.gaps_filled = filler_->fill(film, plan_.window, *options_.deadline);
  result.statistics.gaps_are_paths = filler_->is_by_paths();
  if (!options_.deadline->parent().load()) result.end = RenderEnd::out_of_time;
}

// Shows the preview in pixels without a sample after a stop.
void Picture::show_preview_in_gaps(const Film& film, RenderResult& result) const {
  if (result.end != RenderEnd::stopped) return;
  Image& picture = result.layers[0].image;
  const Image* preview = options_.preview != nullptr ? &options_.preview->picture() : nullptr;
  RenderStatistics& statistics = result.statistics;
  statistics.shows_preview =
      preview != nullptr && preview->width == picture.width && preview->height == picture.height;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      if (film.estimate(plan_.window.x0 + x, plan_.window.y0 + y).samples > 0) continue;
      ++statistics.unsampled;
      if (statistics.shows_preview) picture.at(x, y) = preview->at(x, y);
    }
}

// Fills gaps by the quick integrator of the method, unless that takes longer than the time left and
// paths together. unresolved: share of reflected light that its cells do not have.
void Picture::fill_gaps_by(std::unique_ptr<Integrator> quick, double unresolved) {
  const double pixels = double(plan_.window.width()) * plan_.window.height();
  const double by_paths = seconds_per_gap_ * pixels;
  std::unique_ptr<Integrator> paths = filler_->use(std::move(quick), false);
  keep_time_for_gaps();
  const double left = std::max(options_.deadline->seconds_left(), 0.0);
  if (seconds_per_gap_ * pixels <= left + by_paths) {
    missing_light_ = unresolved;
    return;
  }
  filler_->use(std::move(paths), true);
  seconds_per_gap_ = by_paths / pixels;
  options_.deadline->keep_back(by_paths);
}

// Describes how many viewing rays pixels get.
PlannedPart Picture::planned_viewing_rays(const MethodPlan& plan,
                                          const MethodSettings& settings) const {
  if (plan.is_by_forecast()) {
    const PixelSampling s = sampling_by_paths(*plan.forecast, error_by_paths(settings.error),
                                              most_by_paths(settings.most_viewing_rays));
    return {"viewing rays", fmt::format("{} per pixel, up to {}", s.first, s.most),
            "more until the noise of the pixel is within the allowed error"};
  }
  const int most = most_viewing_rays(options_).in_pixel;
  if (most <= options_.spp)
    return {"viewing rays", fmt::format("{} per pixel", options_.spp), "no refinement"};
  return {"viewing rays", fmt::format("{} per pixel, up to {}", options_.spp, most),
          "more where samples or neighbours differ"};
}

// Leaves the result without layers if it was stopped before there was anything to show.
void Picture::render(const Preparation* preparation, RenderResult& result) {
  const PictureView view{pixels_of(plan_.image), pixels_of(plan_.region), [&](float x, float y) {
                           return viewing_.ray({x, y}, {0.5f, 0.5f});
                         }};
  // Cells and their gathering take about as long as the tiles.
  const double share = needs_cells(options_.method, options_.indirect) ? 0.5 : 0.0;
  const ProgressCallback of_cells = part_of_progress(progress_, 0, share),
                         of_tiles = part_of_progress(progress_, share, 1);
  CellInput cells{picture_pilot(viewing_, size_, options_.seed),
                  &view,
                  options_.seed,
                  of_cells,
                  stop_,
                  {},
                  {},
                  options_.cells,
                  options_.group};
  const MethodSettings settings = method_settings(options_);
  std::optional<Deadline> preparing;  // processes of a group have to agree on what they prepare
  if (filler_ && options_.group == nullptr) {
    constexpr double share_of_rows = 0.3;  // conventional: half of the time is for the pixels
    const std::chrono::duration<double> rows(share_of_rows * options_.deadline->seconds_left());
    preparing.emplace(stop_, Deadline::Clock::now() +
                                 std::chrono::duration_cast<Deadline::Clock::duration>(rows));
    cells.enough = &preparing->flag();
  }
  const std::unique_ptr<Integrator> integrator =
      make_integrator(scene_, options_.method, settings, preparation, &cells, [&](MethodPlan plan) {
        plan.parts.push_back(planned_viewing_rays(plan, settings));
        if (options_.planned) options_.planned(plan);
        result.statistics.plan = std::move(plan);
      });
  RenderStatistics& statistics = result.statistics;
  statistics.cells = cells.statistics;
  for (PlannedPart& d : cells.decisions) statistics.plan.parts.push_back(std::move(d));
  statistics.preparation = cells.counters;
  if (cells.quick) fill_gaps_by(std::move(cells.quick), cells.statistics.unresolved);
  if (!integrator) return;
  statistics.is_by_paths = integrator->sampling().is_by_noise();
  Rendering rendering(scene_, viewing_, *integrator, options_, plan_, of_tiles, stop_);
  rendering.set_seconds_per_gap(seconds_per_gap_);
  result.end = rendering.run();
  statistics.share_done = rendering.share_done();
  finish(rendering.film(), result);
  result.layers = rendering.layers();
  show_preview_in_gaps(rendering.film(), result);
  statistics.counters = rendering.counters();
  statistics.viewing_errors = rendering.viewing_errors();
  statistics.estimated_error = std::hypot(rendering.estimated_error(), missing_light_);
}

}  // namespace

MostViewingRays most_viewing_rays(const RenderOptions& options) {
  const auto all = [](int n) { return MostViewingRays{n, n, n}; };
  if (options.max_spp > 0) return all(std::max(options.max_spp, options.spp));
  const MethodRow& row = options.method.row();
  // Surrogate samples deal with edges cheaply. Further rays serve small, glossy and bright
  // features, so a few pixels may need many.
  if (row.refinement > 1 && !needs_radiosity(options.method, options.indirect)) {
    const int usual = 16 * options.spp;
    if (!needs_cells(options.method, options.indirect))
      return {256 * options.spp, 128 * options.spp, usual};
    return {512 * options.spp, 256 * options.spp, usual};
  }
  return all(row.refinement * options.spp);
}

MethodSettings method_settings(const RenderOptions& o) {
  MethodSettings s;
  s.indirect = o.indirect;
  s.shadow_rays = o.shadow_rays;
  s.error = o.error;
  s.viewing_rays = o.spp;
  s.most_viewing_rays = o.max_spp > 0 ? std::max(o.max_spp, o.spp) : 0;
  s.is_refined = most_viewing_rays(o).in_pixel > o.spp;
  s.trees = o.kj92.sampling;
  s.depth = o.depth;
  s.threads = o.threads;
  return s;
}

void check_options(const PreparedScene& scene, const Camera& camera, const RenderOptions& options) {
  const ImageSize size = image_size(camera, options.width, options.height);
  const TilePlan plan = plan_of(scene, size, options);
  if (film_bytes(options.parts > 1 ? plan.region : plan.window, options) > most_film_bytes)
    throw UsageError("an image of " + std::to_string(plan.window.width()) + "x" +
                     std::to_string(plan.window.height()) +
                     " pixels with these layers takes more than 8 GiB: use --size or --crop");
  check_camera(ViewingCamera(camera, size.width, size.height), plan.window, scene, camera.name);
}

RenderResult render(const PreparedScene& scene, const Camera& camera, const RenderOptions& options,
                    const ProgressCallback& progress, const StopFlag& stop) {
  check_options(scene, camera, options);
  return Picture(scene, camera, options, progress, stop).make();
}

}  // namespace troffer
