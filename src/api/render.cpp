// render() of the public interface.
#include "render/render.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <optional>

#include "api/light_settings.h"
#include "api/picture_impl.h"
#include "api/scene_impl.h"
#include "api/script_words.h"
#include "api/watched.h"
#include "base/deadline.h"
#include "base/error.h"
#include "base/suggestion.h"
#include "render/aov_rows.h"
#include "troffer/render.h"

namespace troffer::api {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int largest_side = 65536, most_shadow_rays = 1 << 20, most_pixel_rays = 1 << 20;

Aov aov_named(const std::string& name) {
  if (const std::optional<Aov> aov = find_aov(name)) return *aov;
  throw UsageError("there is no layer '" + name + "'" + did_you_mean(name, layer_names()));
}

// With 0 initial rays, kj92 samples no source: the picture shows the radiosity solution.
void set_shadow_rays(int rays, troffer::RenderOptions& o) {
  in_range(rays, 0, most_shadow_rays, "shadow_rays");
  if (rays == 0 && o.method != Method::kj92)
    throw UsageError("shadow_rays of 0 belongs to the method kj92");
  BintreeOptions& tree = o.kj92.sampling.tree;
  if (rays == 0) o.kj92.selection.is_restricted = true;
  o.shadow_rays = std::max(rays, 1);
  tree.initial_rays = std::max(rays, 1);
  tree.most_rays = std::max(tree.most_rays, tree.initial_rays);
}

// Gives methods without refinement enough viewing rays to reach the error limit.
void set_error_limit(const RenderOptions& from, troffer::RenderOptions& o) {
  constexpr int enough = 1 << 16;
  if (from.error_limit != 0) in_range(from.error_limit, 1e-6, 10, "error_limit");
  o.error_limit = from.error_limit;
  if (o.error_limit > 0 && from.light.spp == 0 && o.method.row().refinement == 1) o.spp = enough;
}

troffer::RenderOptions options_of(const RenderOptions& from, const troffer::Scene& scene) {
  troffer::RenderOptions o;
  set_light(from.light, scene, o);
  if (from.light.spp > 0) o.spp = from.light.spp;
  if (from.width < 0 || from.height < 0 || from.width > largest_side || from.height > largest_side)
    throw UsageError("width and height lie between 0 and 65536");
  o.width = from.width;
  o.height = from.height;
  o.max_spp = int(in_range(from.max_spp, 0, most_pixel_rays, "max_spp"));
  if (from.crop) {
    o.has_crop = true;
    o.crop = *from.crop;
  }
  if (from.shadow_rays) set_shadow_rays(*from.shadow_rays, o);
  set_error_limit(from, o);
  for (const std::string& name : from.aovs) {
    const Aov aov = aov_named(name);
    if (std::find(o.aovs.begin(), o.aovs.end(), aov) == o.aovs.end()) o.aovs.push_back(aov);
  }
  if (from.time_limit != 0) in_range(from.time_limit, 0.001, 1e9, "time_limit");
  return o;
}

// Passes the fraction done from the working thread to the caller's progress function. The fraction
// never falls.
class Reporter {
 public:
  explicit Reporter(const Progress& progress) : progress_(progress) {}
  void set(double fraction) { fraction_ = fraction; }
  void look(StopFlag& stop) {
    shown_ = std::max(shown_, fraction_.load());
    if (progress_ && !progress_(shown_)) stop = true;
  }

 private:
  const Progress& progress_;
  std::atomic<double> fraction_{0};
  double shown_ = 0;
};

// Does the work of render() on the working thread. If `camera` is null, uses Scene::camera().
void render_picture(Scene& scene, const Camera* camera, const RenderOptions& options,
                    const troffer::RenderOptions& asked, Reporter& reporter,
                    const StopFlag& stopped, Picture::Impl& made) {
  const Clock::time_point start = Clock::now();
  ScriptScene& script = scene.impl().script;
  const bool was_prepared = script.is_prepared();
  const troffer::Camera view = camera != nullptr ? camera_in(script.scene(), *camera)
                                                 : camera_in(script.scene(), scene.camera());
  const std::shared_ptr<const PreparedScene> prepared = script.prepared();
  troffer::RenderOptions o = asked;
  // The prepared scene joins lights in one place, so the selected lights have other numbers there.
  o.kj92.selection.only = kj92_of(options.light.kj92, prepared->scene).selection.only;
  const double build =
      was_prepared ? 0 : std::chrono::duration<double>(Clock::now() - start).count();
  with_script_words([&] { check_options(*prepared, view, o); });
  std::optional<Deadline> deadline;
  if (options.time_limit > 0) {
    const std::chrono::duration<double> limit(options.time_limit);
    deadline.emplace(stopped, start + std::chrono::duration_cast<Clock::duration>(limit));
    o.deadline = &*deadline;
  }
  const StopFlag& stop = deadline ? deadline->flag() : stopped;
  const std::unique_ptr<Preparation> preparation = prepared_for(*prepared, o, stop);
  o.preparation = preparation.get();
  made.result = troffer::render(
      *prepared, view, o, [&](double f) { reporter.set(f); }, stop);
  made.statistics = statistics_of(made.result, build);
}

Picture render_by(Scene& scene, const Camera* camera, const RenderOptions& options,
                  const Progress& progress) {
  const troffer::RenderOptions asked = options_of(options, scene.impl().script.scene());
  auto made = std::make_shared<Picture::Impl>();
  Reporter reporter(progress);
  run_watched(
      [&](StopFlag& stop) { render_picture(scene, camera, options, asked, reporter, stop, *made); },
      [&](StopFlag& stop) { reporter.look(stop); });
  return Picture(std::move(made));
}

}  // namespace

Picture render(Scene& scene, const Camera& camera, const RenderOptions& options,
               const Progress& progress) {
  return render_by(scene, &camera, options, progress);
}

Picture render(Scene& scene, const RenderOptions& options, const Progress& progress) {
  return render_by(scene, nullptr, options, progress);
}

}  // namespace troffer::api
