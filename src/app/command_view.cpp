#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include "app/commands.h"
#include "app/common_options.h"
#include "app/daylight_flags.h"
#include "app/option_values.h"
#include "app/printable.h"
#include "app/signals.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/sun_position.h"
#include "import/kept_files.h"
#include "scene/names.h"
#include "view/view.h"

namespace troffer {

namespace {

Camera camera_named(const Scene& scene, const std::string& name) {
  for (const Camera& camera : scene.cameras)
    if (name.empty() || camera.name == name) return camera;
  if (name.empty()) return {};
  throw UsageError(no_camera_named(scene, name));
}

// "LATITUDE,LONGITUDE,TIME", split at its last comma.
struct PlaceOfTime {
  std::string place, time;
};
PlaceOfTime place_of_time(const std::string& text) {
  const size_t comma = text.rfind(',');
  if (comma == text.npos) return {};
  return {text.substr(0, comma + 1), text.substr(comma + 1)};
}

void read_size(const std::string& text, ViewSettings& settings) {
  if (text.empty()) return;
  constexpr int most = 4096;
  const char* const end = text.data() + text.size();
  const auto [middle, error] = std::from_chars(text.data(), end, settings.width);
  const bool has_x = error == std::errc() && middle != end && *middle == 'x';
  const auto height = has_x ? std::from_chars(middle + 1, end, settings.height)
                            : std::from_chars_result{middle, std::errc::invalid_argument};
  if (height.ec != std::errc() || height.ptr != end || settings.width < 1 || settings.height < 1 ||
      settings.width > most || settings.height > most)
    throw UsageError("--size: '" + text +
                     "' is not WIDTHxHEIGHT with sides of up to 4096, such as 640x480");
}

}  // namespace

void add_view(CLI::App& app, ViewCommand& c) {
  CLI::App* s = app.add_subcommand("view", "Look at a scene and measure in it, in a browser");
  add_scene_choice(*s, c.scene);
  s->add_option("--port", c.port, "Port of the page's address on this machine [any free one]")
      ->check(whole_number_between(1, 65535));
  s->add_option("--size", c.size, "Picture size in pixels [about 640x480]");
  s->add_option("--camera", c.camera,
                "Camera to start with; troffer info lists the names [the first]");
  s->add_option("--annual", c.annual,
                "Folder that troffer annual wrote: the page shows its sensors in every hour");
  add_method(*s, c.method);
  s->add_option("--error", c.error, "Standard error at which a picture is finished")
      ->check(number_between(1e-3, 1))
      ->capture_default_str();
  add_light_choice(*s, c.lights);
  add_daylight_options(*s, c.daylight);
  add_threads(*s, c.threads);
  add_seed(*s, c.seed);
  s->add_flag("--quiet", c.is_quiet, "No warnings");
}

int run_view(const ViewCommand& c) {
  if (!std::isfinite(c.error)) throw UsageError("--error: not a number");
  ViewSettings settings;
  settings.options.method = parse_method(c.method);
  settings.options.error = c.error;
  settings.options.threads = c.threads;
  settings.options.seed = c.seed;
  settings.file = c.scene.file;
  read_size(c.size, settings);
  if (!c.annual.empty()) settings.year = std::make_shared<StoredHours>(read_stored_year(c.annual));
  const ThreadLimit limit(c.threads);
  const PlaceOfTime at = place_of_time(c.daylight.at);
  // Another time of day relights the scene as it was read, even if its files change.
  SceneChoice choice = c.scene;
  std::optional<KeptFiles> kept;
  if (!at.time.empty()) {
    choice.scene = std::make_shared<const Scene>(read_scene(choice, c.is_quiet));
    kept.emplace();
  }
  UpUse up{true, {}};
  Scene scene = load_scene(choice, c.lights, &c.daylight, c.is_quiet, up);
  const auto& warnings = scene.warnings.entries();
  if (std::any_of(warnings.begin(), warnings.end(),
                  [](const Warning& w) { return w.text == default_sky_warning; })) {
    settings.notice =
        "The scene has no light. A uniform sky of 10 000 lx was added to show it, so values in "
        "this picture say nothing about the scene. --sky none keeps it dark.";
  }
  settings.camera = camera_named(scene, c.camera);
  settings.up = normalize(up.decision.up);
  if (!at.time.empty()) {
    settings.time = at.time;
    settings.relit = [&c, at, choice](const std::string& time) {
      parse_time(time, "time");
      DaylightOptions daylight = c.daylight;
      daylight.at = at.place + time;
      UpUse same;
      return load_scene(choice, c.lights, &daylight, true, same);
    };
  }
  ViewStart start;
  start.port = uint16_t(c.port);
  start.has_camera = !scene.cameras.empty();
  start.tell = [](const std::string& address) {
    fmt::print("{}\n", address);
    std::fflush(stdout);
  };
  if (!c.is_quiet)
    start.note = [](const std::string& note) { fmt::print(stderr, "note: {}\n", printable(note)); };
  const StopFlag& stop = install_stop_handlers();
  return view(std::move(scene), settings, start, stop) ? exit_done : exit_interrupted;
}

}  // namespace troffer
