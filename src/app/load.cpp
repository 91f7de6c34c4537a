#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "app/commands.h"
#include "app/option_values.h"
#include "app/printable.h"
#include "app/progress.h"
#include "base/error.h"
#include "import/import.h"
#include "lighting/dimming.h"
#include "lighting/option_text.h"
#include "render/placement.h"
#include "scene/joined_lights.h"

namespace troffer {

namespace {

// Adds GROUP=N.
void add_state(const std::string& text, std::map<std::string, size_t>& states) {
  constexpr double most_states = 1e6;
  const size_t at = text.rfind('=');
  const auto number = at == std::string::npos ? std::nullopt : parse_number(text.substr(at + 1));
  if (!number || at == 0 || !(*number >= 0 && *number < most_states) ||
      *number != std::floor(*number))
    throw UsageError("--state: '" + printable(text) + "' is not GROUP=NUMBER");
  states[text.substr(0, at)] = size_t(*number);
}

}  // namespace

void add_scene_choice(CLI::App& app, SceneChoice& choice) {
  app.add_option("scene", choice.file, "Scene: .gltf .glb .pbrt .obj .ply .stl .xml .rad .hbjson")
      ->required();
  app.add_option("--variant", choice.options.variant, "glTF: name of the material variant");
  app.add_option("--time", choice.options.time,
                 "glTF: time in the animation, in seconds [rest pose]")
      ->check(number_between(-1e9, 1e9));
  app.add_option("--animation", choice.options.animation,
                 "glTF: name of the animation [the first]");
  app.add_option_function<std::vector<std::string>>(
         "--state",
         [&choice](const std::vector<std::string>& texts) {
           for (const std::string& text : texts) add_state(text, choice.options.states);
         },
         "HBJSON: number of the state, from 0, that a dynamic group shows [0]; may be repeated")
      ->allow_extra_args(false);
  app.add_option(
      "--up", choice.up,
      "Upward direction: x, y, z, -y … or X,Y,Z [glTF: y; Radiance, HBJSON: z; others: guessed "
      "from cameras, names and objects that stand on others]");
  app.add_option(
         "--emission-scale", choice.options.emission_scale,
         "Factor on the emission of surfaces in the file, such as 683 for files from Blender")
      ->check(number_between(0, 1e9))
      ->capture_default_str();
  app.add_flag("--baked", choice.options.shows_baked,
               "glTF: show the light that troffer bake wrote instead of computing it");
}

namespace {

Scene import_shown(const SceneChoice& choice, ImageUse images, bool is_quiet) {
  if (choice.scene) return *choice.scene;
  const std::string name = std::filesystem::path(choice.file).filename().string();
  ProgressBar bar("reading " + printable(name), is_quiet);
  ImportOptions options = choice.options;
  options.progress = [&](double fraction) { bar.update(fraction); };
  options.images = images;
  return import_scene(choice.file, options);
}

void tell_warnings(const Scene& scene) {
  constexpr size_t most_lines = 20;
  const auto& entries = scene.warnings.entries();
  for (size_t i = 0; i < entries.size() && i < most_lines; ++i) {
    fmt::print(stderr, "warning: {}", printable(entries[i].text));
    if (entries[i].count > 1) fmt::print(stderr, " ({} times)", entries[i].count);
    fmt::print(stderr, "\n");
  }
  if (entries.size() > most_lines)
    fmt::print(stderr, "warning: {} more kinds of warnings (troffer info lists them)\n",
               entries.size() - most_lines);
}

}  // namespace

Scene read_scene(const SceneChoice& choice, bool is_quiet) {
  return import_shown(choice, ImageUse::read, is_quiet);
}

Scene load_scene(const SceneChoice& choice, const std::vector<std::string>& lights,
                 const DaylightOptions* daylight, bool is_quiet, UpUse& up,
                 const ShowShapes& show_shapes) {
  if (!choice.up.empty()) parse_up(choice.up);  // reports a mistake before any work
  Scene scene = import_shown(choice, show_shapes ? ImageUse::left_out : ImageUse::read, is_quiet);
  if (scene.skipped_image_bytes.value_or(0) > 0) {
    show_shapes(scene);
    scene = Scene();  // frees it before the scene is read again
    scene = import_shown(choice, ImageUse::read, is_quiet);
  }
  scene.skipped_image_bytes.reset();
  up.decision = up_of(choice, scene);
  const size_t lights_in_file = scene.lights.size();
  if (daylight != nullptr) add_daylight(scene, *daylight, up.decision);
  const bool has_new_light = scene.lights.size() > lights_in_file;
  const bool is_up_used =
      up.is_needed || (daylight != nullptr && (has_new_light || depends_on_up(*daylight)));
  if (up.is_needed && !up.decision.doubt.empty()) scene.warnings.add(up.decision.doubt);
  if (bounds(scene).is_empty() && scene.lights.empty())
    throw InputError(choice.file, 0, 0, "is empty: it has neither surfaces nor lights");
  // Without `daylight`, the command itself brings light.
  if (!shines(scene) && daylight != nullptr)
    scene.warnings.add("there is no light: nothing will be seen");
  if (!lights.empty()) scene = with_only_lights(std::move(scene), lights);
  if (daylight != nullptr) check_light(scene, *daylight, lights);
  scene = with_joined_lights(std::move(scene));
  if (is_quiet) return scene;
  tell_warnings(scene);
  if (is_up_used) tell_up(up.decision);
  return scene;
}

UpDecision up_of(const SceneChoice& choice, const Scene& scene) {
  return choice.up.empty() ? decide_up(scene) : requested_up(parse_up(choice.up));
}

void tell_up(const UpDecision& decision) {
  if (decision.basis == UpBasis::evidence && decision.doubt.empty())
    fmt::print(stderr, "note: {} (--up chooses another direction)\n", describe(decision));
}

void warn_of_misplaced(const PreparedScene& scene, bool is_quiet) {
  if (is_quiet) return;
  for (const std::string& text : misplaced_luminaires(scene))
    fmt::print(stderr, "warning: {}\n", printable(text));
}

Method parse_method(const std::string& name) {
  const std::optional<Method> method = Method::find(name);
  if (!method) throw UsageError("--method: there is no '" + name + "', but " + Method::names());
  return *method;
}

Indirect parse_indirect(const std::string& name) {
  const std::optional<Indirect> indirect = Indirect::find(name);
  if (!indirect) throw UsageError("--indirect: there is no '" + name + "'");
  return *indirect;
}

void check_exposure(const std::string& text) {
  if (text.empty() || text == "auto") return;
  constexpr double most = 60;
  const std::optional<double> stops = parse_number(text);
  if (!stops || !(std::abs(*stops) <= most))
    throw UsageError("--exposure: '" + text + "' is neither auto nor stops between -60 and 60");
}

}  // namespace troffer
