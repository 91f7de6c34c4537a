#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/common_options.h"
#include "app/daylight_flags.h"
#include "app/option_values.h"
#include "app/output_guard.h"
#include "app/outputs.h"
#include "app/process.h"
#include "app/progress.h"
#include "app/signals.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/units.h"
#include "image/output_set.h"
#include "image/read_image.h"
#include "image/write_image.h"
#include "import/file.h"
#include "render/camera.h"
#include "report/daylight_glare.h"
#include "scene/names.h"

namespace troffer {

namespace {

using Json = nlohmann::ordered_json;

bool is_picture(const std::string& path) {
  const std::string ending = lower_case_ending(path);
  return ending == "exr" || ending == "hdr" || ending == "pfm";
}

// Returns the fisheye camera of the view; `up` is the scene's.
Camera glare_camera(const Scene& scene, const GlareCommand& c, const Vec3& up) {
  Camera camera;
  if (!c.eye.empty() || !c.target.empty()) {
    if (c.eye.empty() || c.target.empty()) throw UsageError("--eye and --target go together");
    if (!c.camera.empty()) throw UsageError("--camera and --eye exclude each other");
    camera = look_at(Vec3(parse_vector(c.eye, "--eye") - scene.origin),
                     Vec3(parse_vector(c.target, "--target") - scene.origin), up, 90);
  } else if (!c.camera.empty()) {
    const auto named = std::find_if(scene.cameras.begin(), scene.cameras.end(),
                                    [&](const Camera& k) { return k.name == c.camera; });
    if (named == scene.cameras.end()) throw UsageError(no_camera_named(scene, c.camera));
    camera = *named;
  } else if (!scene.cameras.empty()) {
    camera = scene.cameras.front();
  } else {
    throw UsageError("glare: give --eye X,Y,Z and --target X,Y,Z: the scene has no camera");
  }
  camera.kind = CameraKind::fisheye;
  camera.half_extent = pi_f / 2;
  camera.has_screen_window = false;
  camera.lens_radius = camera.near_clip = camera.far_clip = 0;
  return camera;
}

// Luminances of a picture in W/(m² sr), or in cd/m² if it is photometric.
Image luminances_of(const Image& picture, bool is_photometric) {
  Image out = picture;
  const float scale = is_photometric ? 1.0f : float(luminous_efficacy);
  for (Rgb& p : out.pixels) p = Rgb{luminance(p) * scale};
  return out;
}

// Converts a picture in cd/m² to W/(m² sr), in which pictures are written and read.
void make_radiometric(Image& picture) {
  for (Rgb& p : picture.pixels) p *= float(1 / luminous_efficacy);
}

Json json_of(const DaylightGlare& g) {
  Json j{{"dgp", g.dgp},
         {"dgi", g.dgi},
         {"ugr", g.ugr},
         {"vertical_illuminance_lx", g.vertical_lx},
         {"mean_luminance", g.mean_luminance},
         {"background_luminance", g.background_luminance},
         {"threshold", g.threshold}};
  j["sources"] = Json::array();
  for (const DaylightGlareSource& s : g.sources)
    j["sources"].push_back({{"direction", {s.direction.x, s.direction.y, s.direction.z}},
                            {"pixel", {s.pixel.x, s.pixel.y}},
                            {"pixels", s.pixels},
                            {"luminance", s.luminance},
                            {"solid_angle", s.solid_angle},
                            {"position_index", s.position_index},
                            {"illuminance_lx", s.illuminance}});
  return j;
}

void print(const DaylightGlare& g) {
  fmt::print("DGP         {:.4f}\n", g.dgp);
  fmt::print("DGI         {:.2f}\n", g.dgi);
  fmt::print("UGR         {:.2f}\n", g.ugr);
  fmt::print("Ev          {:.1f} lx\n", g.vertical_lx);
  fmt::print("mean        {:.1f} cd/m2\n", g.mean_luminance);
  fmt::print("background  {:.1f} cd/m2\n", g.background_luminance);
  fmt::print("threshold   {:.1f} cd/m2\n", g.threshold);
  fmt::print("sources     {}\n", g.sources.size());
  if (g.sources.empty()) return;
  fmt::print("  right    up        cd/m2          sr    position index          lx\n");
  for (const DaylightGlareSource& s : g.sources)
    fmt::print("{:7.1f} {:5.1f} {:12.5g} {:11.4g} {:17.3f} {:11.4g}\n",
               deg_from_rad(std::atan2(s.direction.x, s.direction.z)),
               deg_from_rad(std::asin(std::clamp(s.direction.y, -1.0, 1.0))), s.luminance,
               s.solid_angle, s.position_index, s.illuminance);
}

int tell(const GlareCommand& c, const Image& luminances) {
  GlareSettings settings = c.settings;
  if (!c.task.empty()) {
    const Vec3d task = parse_vector(c.task + ",0", "--task");
    settings.task = Vec2{float(task.x), float(task.y)};
  }
  const DaylightGlare glare = daylight_glare(luminances, settings);
  if (c.is_json)
    fmt::print("{}\n", json_of(glare).dump(2));
  else
    print(glare);
  return exit_done;
}

}  // namespace

void add_glare(CLI::App& app, GlareCommand& c) {
  CLI::App* s = app.add_subcommand("glare", "Rate the daylight glare of a view: DGP");
  add_scene_choice(*s, c.scene);
  s->add_option("--eye", c.eye, "Position of the eye");
  s->add_option("--target", c.target, "Point that the eye looks at");
  s->add_option("--camera", c.camera, "Name of the camera whose place and direction are taken");
  s->add_option("--width", c.side, "Side of the fisheye picture, in pixels")
      ->check(whole_number_between(64, 4096))
      ->capture_default_str();
  s->add_option("--threshold", c.settings.threshold,
                "Luminance from which a pixel belongs to a source, cd/m2; up to 100: a factor on "
                "the mean luminance of the task, or of the picture")
      ->check(number_between(0, 1e12))
      ->capture_default_str();
  s->add_option("--task", c.task, "Pixel in the middle of the task area, from the top left");
  s->add_option("--task-angle", c.settings.task_rad, "Opening angle of the task area, radians")
      ->check(number_between(1e-3, 3))
      ->capture_default_str();
  s->add_option("--search-radius", c.settings.search_rad,
                "Pixels of sources up to half of this apart belong together, radians")
      ->check(number_between(0, 3))
      ->capture_default_str();
  s->add_option("--peak", c.settings.peak,
                "Luminance from which a part of a source counts apart, cd/m2; 0: never")
      ->check(number_between(0, 1e12))
      ->capture_default_str();
  s->add_flag("--no-low-light", c.leaves_low_light, "No correction of the DGP below 1000 lx");
  s->add_option("-o,--output", c.output, "Picture file for the fisheye: .exr .hdr .pfm .png");
  s->add_flag("--json", c.is_json, "Print JSON");
  add_method(*s, c.method);
  s->add_option("--error", c.error,
                "certified: allowed standard error of a pixel, relative to its light")
      ->check(number_between(1e-6, 1))
      ->capture_default_str();
  add_light_choice(*s, c.lights);
  add_daylight_options(*s, c.daylight);
  c.daylight.adds_default_sky = false;  // no rating may depend on a sky that nobody asked for
  add_threads(*s, c.threads);
  add_seed(*s, c.seed);
  s->add_flag("--quiet", c.is_quiet, "No progress bar, notes or warnings");
}

int run_glare(GlareCommand c) {
  c.settings.corrects_low_light = !c.leaves_low_light;
  if (is_picture(c.scene.file)) {
    if (!c.output.empty()) throw UsageError("glare: -o needs a scene, not a picture");
    return tell(c, luminances_of(read_image(c.scene.file), false));
  }
  if (!c.output.empty()) image_format(c.output);
  RenderOptions options;
  options.method = parse_method(c.method);
  options.error = c.error;
  options.width = options.height = c.side;
  options.threads = c.threads;
  options.seed = c.seed;
  options.indirect = Indirect::automatic;
  // Indices are sums over many pixels, so noise of single ones hardly counts. Sources' edges need
  // a few more rays than the first pass.
  options.max_spp = 16;
  OutputGuard guard;
  guard.add_inputs(c.scene, c.daylight);
  guard.add_output("-o", c.output);
  const ThreadLimit limit(c.threads);
  UpUse up{true, {}};
  Scene imported = load_scene(c.scene, c.lights, &c.daylight, c.is_quiet, up);
  guard.check_files_read();
  const Camera camera = glare_camera(imported, c, up.decision.up);
  const PreparedScene scene(std::move(imported));
  const StopFlag& stop = install_stop_handlers();
  RenderResult result;
  {
    ProgressBar bar("glare", c.is_quiet);
    result = render(
        scene, camera, options, [&](double f) { bar.update(f); }, stop);
  }
  if (!result.is_complete) {
    fmt::print(stderr, "interrupted: the view is not rated\n");
    return exit_interrupted;
  }
  const Image luminances = luminances_of(result.layers[0].image, scene.scene.is_photometric);
  if (!c.output.empty()) {
    if (scene.scene.is_photometric) make_radiometric(result.layers[0].image);
    OutputSet files;
    files.add(c.output, result.layers, WriteOptions());
    files.commit();
  }
  return tell(c, luminances);
}

}  // namespace troffer
