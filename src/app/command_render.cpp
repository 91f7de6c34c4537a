#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <optional>

#include "app/commands.h"
#include "app/lasting_run.h"
#include "app/output_guard.h"
#include "app/outputs.h"
#include "app/picture_files.h"
#include "app/process.h"
#include "app/progress.h"
#include "app/render_statistics.h"
#include "app/signals.h"
#include "app/solution_file.h"
#include "app/unfinished.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/process_group.h"
#include "image/output_set.h"
#include "render/camera.h"
#include "render/framing.h"
#include "render/preview.h"
#include "scene/names.h"

namespace troffer {

namespace {

// Throws InputError if no picture can show anything: no surface, and no environment light.
void check_visible(const Scene& scene) {
  const auto is_seen = [](const Light& e) {
    return e.kind == LightKind::environment || e.kind == LightKind::sky || e.kind == LightKind::sun;
  };
  if (bounds(scene).is_empty() && std::none_of(scene.lights.begin(), scene.lights.end(), is_seen))
    throw InputError(scene.file, 0, 0, "has nothing to show: no surface, sky or image");
}

// Returns the camera of --eye and --target, which are in the file's coordinates; empty if neither
// is given.
std::optional<Camera> described_camera(const RenderCommand& c, const Vec3d& origin,
                                       const Vec3& up) {
  if (c.eye.empty() && c.target.empty()) return std::nullopt;
  if (c.eye.empty() || c.target.empty()) throw UsageError("--eye and --target go together");
  if (!c.camera.empty()) throw UsageError("--camera and --eye exclude each other");
  return look_at(Vec3(parse_vector(c.eye, "--eye") - origin),
                 Vec3(parse_vector(c.target, "--target") - origin), up, c.fov_deg);
}

// Returns the chosen camera; empty if the scene has none and none is described.
std::optional<Camera> choose_camera(const Scene& scene, const RenderCommand& c, const Vec3& up) {
  if (const auto described = described_camera(c, scene.origin, up)) return described;
  if (!c.camera.empty()) {
    for (const Camera& camera : scene.cameras)
      if (camera.name == c.camera) return camera;
    throw UsageError(no_camera_named(scene, c.camera));
  }
  if (!scene.cameras.empty()) return scene.cameras.front();
  return std::nullopt;
}

// Places a camera in a scene without one, with a warning.
Camera place_camera(const PreparedScene& scene, const RenderCommand& c, const Vec3& up) {
  if (!c.is_quiet)
    fmt::print(
        stderr,
        "warning: the scene has no camera; one is placed {} (--eye, --target and --up choose "
        "another)\n",
        is_room(scene) ? "inside its bounds" : "in front of it");
  return framing_camera(scene, up);
}

// Refuses outputs that would overwrite inputs or each other.
void guard_files(const RenderCommand& c, OutputGuard& guard) {
  guard.add_inputs(c.scene, c.daylight);
  guard.add_outputs("-o", c.outputs);
  guard.add_output("--stats", c.stats);
  guard.add_output("--checkpoint", c.lasting.checkpoint);
  const bool keeps_cells = needs_cells(c.options.method, c.options.indirect);
  if (keeps_cells && c.options.parts == 1)
    guard.add_output("--solution", c.solution);
  else
    guard.add_input("--solution", c.solution);
}

// Checks everything that can be checked before any work, and reserves the files to write.
std::vector<OutputReservation> check_and_reserve(RenderCommand& c,
                                                 std::optional<OutputGuard>& guard) {
  c.options.method = parse_method(c.method);
  check_method(c.options.method, c.options.indirect, c.solution);
  for (const std::string& path : c.outputs)
    image_format(path);  // throws UsageError for an unknown
                         // ending
  // Reports mistakes before the scene is read. The coordinates are not relative to the scene's
  // origin yet, so far places lose precision here.
  described_camera(c, c.eye.empty() ? Vec3d{} : parse_vector(c.eye, "--eye"), {0, 0, 1});
  if (c.options.group != nullptr && !c.options.group->leads()) return {};
  guard_files(c, guard.emplace());
  std::vector<OutputReservation> reserved = reserve_outputs(c.outputs, c.stats);
  // Parts do not write cells, so that all parts use the same ones.
  if (c.options.parts == 1)
    reserve_cells(c.solution, c.options.method, c.options.indirect, reserved);
  reserve_checkpoint(c, reserved);
  return reserved;
}

RenderResult render_with_bar(const PreparedScene& scene, const Camera& camera,
                             const RenderCommand& c, const StopFlag& stop) {
  ProgressBar bar("render", c.is_quiet);
  return render(
      scene, camera, c.options, [&](double f) { bar.update(f); }, stop);
}

// A picture, and the cells to keep after it is written.
struct Rendered {
  RenderResult result;
  std::unique_ptr<CellStore> cells;
};

Rendered prepare_and_render(const PreparedScene& scene, const Camera& camera, RenderCommand& c,
                            const StopFlag& stop, RenderSeconds& seconds) {
  double cpu = cpu_seconds();
  const auto preparation =
      prepare_method(scene, c.options.method, c.options.kj92, c.options.indirect, c.solution,
                     c.options.threads, c.is_quiet, stop);
  seconds.preprocess_cpu = cpu_seconds() - cpu;
  cpu = cpu_seconds();
  c.options.preparation = preparation.get();
  Rendered made;
  made.cells = cells_of_file(scene, c.options.method, c.options.indirect, c.solution);
  c.options.cells = made.cells.get();
  made.result = render_with_bar(scene, camera, c, stop);
  c.options.preparation = nullptr;
  seconds.render = made.result.statistics.render_seconds;
  seconds.render_cpu = cpu_seconds() - cpu;
  return made;
}

// Prints how much of the picture an interrupted rendering has finished.
void tell_interrupted(const RenderStatistics& s, const Unfinished& left) {
  const size_t pixels = size_t(s.width) * size_t(s.height);
  std::string missing;
  if (s.unsampled == pixels)
    missing = " before the first pixel was finished";
  else if (s.unsampled > 0)
    missing = fmt::format(" ({} of {} pixels are {})", s.unsampled, pixels,
                          s.shows_preview ? "the preview's" : "black, as they have no sample yet");
  fmt::print(stderr, "interrupted{}: {}\n", missing, left.text());
}

void tell_written(const RenderCommand& c, double total, double error) {
  std::vector<std::string> files = c.outputs;
  if (!c.stats.empty()) files.push_back(c.stats);
  tell_done(files, total, error);
}

// Prints the final messages and returns the exit status.
int tell(const RenderResult& result, const RenderCommand& c, double total, const Unfinished& left) {
  const RenderStatistics& s = result.statistics;
  const uint64_t bad = s.counters.nan_samples;
  if (!c.is_quiet && bad > 0)
    fmt::print(stderr, "warning: {} samples were not finite and count as black\n", bad);
  switch (result.end) {
    case RenderEnd::stopped:
      tell_interrupted(s, left);
      return exit_interrupted;
    case RenderEnd::out_of_time:
      fmt::print(stderr,
                 "time limit: wrote the picture after {:.1f} s, with {:.0f} % of the work done{}\n",
                 total, 100 * s.share_done,
                 s.gaps_filled == 0
                     ? ""
                     : fmt::format("; {} of {} pixels are {}", s.gaps_filled,
                                   size_t(s.width) * size_t(s.height),
                                   s.gaps_are_paths ? "by paths alone" : "a first estimate"));
      break;
    case RenderEnd::good_enough:
    case RenderEnd::complete:
      if (!c.is_quiet && s.estimated_error > c.lasting.error_limit && c.lasting.error_limit > 0)
        fmt::print(stderr,
                   "warning: the estimated error of the picture is {:.3g}, above --error-limit: "
                   "raise --max-spp or --spp, or lower --error\n",
                   s.estimated_error);
      if (!c.is_quiet) tell_written(c, total, s.estimated_error);
  }
  return exit_done;
}

// Adds the picture's outputs to the set. An unfinished picture never replaces another file. It is
// not written if it is blank, or if a checkpoint and an earlier unfinished picture hold more.
void add_outputs(const RenderCommand& c, const RenderResult& result, const Camera& camera,
                 const LastingRun& lasting, PreviewFiles& files, Unfinished& left, OutputSet& set) {
  const RenderStatistics& s = result.statistics;
  const bool is_unfinished = result.end == RenderEnd::stopped;
  const bool is_blank =
      is_unfinished && !s.shows_preview && s.unsampled == result.layers[0].image.pixels.size();
  WriteOptions write = write_options(c, camera, result.layers[0].image, c.is_quiet || is_blank);
  write.note = lasting.note(result, camera);
  if (c.options.parts > 1) {
    const ImageSize whole = image_size(camera, c.options.width, c.options.height);
    write.window = {result.window[0], result.window[1], whole.width, whole.height};
  }
  for (const std::string& path : c.outputs) {
    std::string place = path;
    if (is_blank)
      place.clear();
    else if (is_unfinished)
      place = files.take_place(path, !c.lasting.checkpoint.empty());
    if (is_unfinished) left.note(path, place);
    if (place.empty()) continue;
    set.add(place, result.layers, write);
  }
}

// Writes pictures and statistics; they replace older ones together, the first picture last.
void write_files(const RenderCommand& c, const RenderResult& result, const Camera& camera,
                 const LastingRun& lasting, PreviewFiles& files, Unfinished& left,
                 const std::function<std::string()>& statistics) {
  const bool is_unfinished = result.end == RenderEnd::stopped;
  OutputSet set;
  add_outputs(c, result, camera, lasting, files, left, set);
  if (!c.stats.empty()) set.add(is_unfinished ? left.place(c.stats) : c.stats, statistics());
  if (!is_unfinished) set.rename_last(c.outputs.front());
  set.commit(!c.lasting.checkpoint.empty());  // must be on disk before the checkpoint is removed
  if (is_unfinished) return;
  for (const std::string& path : c.outputs) files.is_finished(path);
}

// Only the leading process shows progress and keeps files.
void join(RenderCommand& c, ProcessGroup& group) {
  if (c.options.threads == 0) c.options.threads = group.default_threads();
  if (group.leads()) return;
  c.is_quiet = true;
  c.has_preview = false;
  c.stats.clear();
  c.lasting.checkpoint.clear();
  c.lasting.time_limit = 0;
}

void restrict_selection(const Scene& scene, RenderCommand& c) {
  if (c.selected_lights.empty()) return;
  c.options.kj92.selection.is_restricted = true;
  c.options.kj92.selection.only = lights_named(scene, c.selected_lights);
}

void set_up_method(const Scene& scene, RenderCommand& c) {
  restrict_selection(scene, c);
  if (c.explains)
    c.options.planned = [](const MethodPlan& plan) { fmt::print(stderr, "{}", as_text(plan)); };
}

const StopFlag& stop_flag_of(ProcessGroup* group) {
  const StopFlag& asked = install_stop_handlers();
  if (group == nullptr) return asked;
  stop_on_user_signal();
  group->watch(asked);
  return group->stop_flag();
}

}  // namespace

int run_render(RenderCommand c) {
  const Clock::time_point start = Clock::now();
  ProcessGroup* group = c.options.group;
  if (group != nullptr) join(c, *group);
  std::optional<OutputGuard> guard;
  const std::vector<OutputReservation> reserved = check_and_reserve(c, guard);
  warn_of_layers(c);

  RenderSeconds seconds;
  const ThreadLimit limit(c.options.threads);
  Camera camera;
  PreviewFiles files(c, camera);
  Preview preview([&](const Image& picture) { files.write(picture); });
  const auto show_sight = [&](const Scene& shapes, bool has_images) {
    if (guard) guard->check_files_read();
    const Vec3 up_seen = up_of(c.scene, shapes).up;
    const std::optional<Camera> chosen = choose_camera(shapes, c, up_seen);
    if (!chosen && !(bounds(shapes).diagonal() > 0)) return;
    camera = chosen ? *chosen : default_camera(shapes, up_seen);
    preview.sight(shapes, camera, c.options, has_images);
  };
  ShowShapes show_shapes;
  if (c.has_preview) show_shapes = [&](const Scene& shapes) { show_sight(shapes, true); };
  UpUse up{!c.eye.empty(), {}};
  Scene imported = load_scene(c.scene, c.lights, &c.daylight, c.is_quiet, up, show_shapes);
  if (guard) guard->check_files_read();
  seconds.import = seconds_since(start);
  Clock::time_point mark = Clock::now();
  if (c.has_preview) show_sight(imported, false);
  check_visible(imported);
  const std::optional<Camera> chosen = choose_camera(imported, c, up.decision.up);
  if (chosen) camera = *chosen;
  const PreparedScene scene(std::move(imported));
  warn_of_misplaced(scene, c.is_quiet);
  if (!chosen) camera = place_camera(scene, c, up.decision.up);
  seconds.build = seconds_since(mark);

  check_options(scene, camera, c.options);  // before the radiosity, which may take long

  set_up_method(scene.scene, c);
  LastingRun lasting(c, start, stop_flag_of(group));
  lasting.begin(scene.scene, camera);
  const StopFlag& stop = lasting.stop();
  if (c.has_preview) {
    preview.look(scene, camera, c.options, stop);
    c.options.preview = &preview;
  }
  lasting.agree();
  const auto [result, cells] = prepare_and_render(scene, camera, c, stop, seconds);
  if (group != nullptr && !group->leads()) return exit_done;
  mark = Clock::now();
  Unfinished left;
  write_files(c, result, camera, lasting, files, left, [&, &made = result] {
    seconds.write = seconds_since(mark);
    return statistics_json(c, made, seconds, seconds_since(start), up.decision);
  });
  lasting.finish(result);
  if (c.options.parts == 1) keep_cells(scene, cells.get(), c.solution, c.is_quiet);
  return tell(result, c, seconds_since(start), left);
}

}  // namespace troffer
