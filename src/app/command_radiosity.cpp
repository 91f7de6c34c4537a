#include <fmt/format.h>

#include <CLI/CLI.hpp>
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
#include "app/solution_file.h"
#include "app/unfinished.h"
#include "app/up_json.h"
#include "base/error.h"
#include "base/parallel.h"
#include "image/output_set.h"
#include "import/file.h"
#include "render/radiosity.h"
#include "render/radiosity_gltf.h"
#include "render/render.h"

namespace troffer {

namespace {

// Checks everything that can be checked before any work.
void check_command(const RadiosityCommand& c) {
  check(c.options);
  for (const std::string& path : c.outputs) {
    const std::string ending = lower_case_ending(path);
    // A solution with such an ending is probably a mistake.
    for (const char* other : {"exr", "hdr", "pfm", "png", "jpg", "pbrt", "obj", "csv", "json"})
      if (ending == other)
        throw UsageError("radiosity writes .gltf, .glb or a solution (.trad), not ." + ending);
    if (c.makes_cells && (ending == "gltf" || ending == "glb"))
      throw UsageError("--cells cannot be written as ." + ending + ": give a file for --solution");
  }
}

// Makes the files of --cells, for --method certified, as render --solution would.
int make_cell_files(const RadiosityCommand& c, const PreparedScene& scene, const StopFlag& stop) {
  const double error = RenderOptions{}.error;  // default of render
  CellStore store;
  {
    ProgressBar bar("cells", c.is_quiet);
    store = cells_of_surfaces(
        scene, error, c.options.seed, c.threads, [&](double f) { bar.update(f); }, stop);
  }
  if (!store.map) {
    Unfinished left;
    for (const std::string& path : c.outputs) left.note(path, "");
    fmt::print(stderr, "interrupted: {}\n", left.text());
    return exit_interrupted;
  }
  for (const std::string& path : c.outputs) keep_cells(scene, &store, path, c.is_quiet);
  return exit_done;
}

std::vector<uint8_t> output_for(const std::string& path, const PreparedScene& scene,
                                const RadiositySolution& solution) {
  const std::string ending = lower_case_ending(path);
  if (ending == "gltf") return radiosity_gltf(scene.scene, solution, GltfContainer::text);
  if (ending == "glb") return radiosity_gltf(scene.scene, solution, GltfContainer::binary);
  return save_radiosity(scene, solution);
}

double percent(double part, double whole) {
  return whole > 0 ? 100 * part / whole : 0.0;
}

void print_summary(const RadiosityResult& r) {
  const RadiositySolution& s = r.solution;
  const EnergyBalance& b = s.balance;
  fmt::print("{} elements of up to {:.3g} m, {} sample points, {} patches of up to {:.3g} m\n",
             s.mesh.element_count, s.mesh.element_size, s.mesh.points.size(), s.mesh.patches.size(),
             s.mesh.patch_size);
  fmt::print("{} shots, {:.1f} million rays, {:.1f} s\n", s.shots, double(s.rays) * 1e-6,
             r.seconds);
  fmt::print(
      "of the emitted power, {:.2f} % is absorbed, {:.2f} % is left to specular surfaces, {:.2f} % "
      "escapes, {:.2f} % is unshot, {:.2f} % is unaccounted for\n",
      percent(b.absorbed, b.emitted), percent(b.lost_to_specular, b.emitted),
      percent(b.escaped, b.emitted), percent(b.unshot, b.emitted),
      percent(b.unaccounted, b.emitted));
}

const char* end_name(RadiosityEnd end) {
  switch (end) {
    case RadiosityEnd::converged:
      return "converged";
    case RadiosityEnd::stopped:
      return "stopped";
    case RadiosityEnd::out_of_shots:
      return "out of shots";
    case RadiosityEnd::out_of_rays:
      return "out of rays";
  }
  return "";
}

struct RadiositySeconds {
  double import = 0, build = 0, write = 0, total = 0;
};

std::string statistics_json(const RadiosityCommand& c, const RadiosityResult& r,
                            const RadiositySeconds& t, const UpDecision& up) {
  const RadiositySolution& s = r.solution;
  const EnergyBalance& b = s.balance;
  nlohmann::ordered_json j;
  j["version"] = TROFFER_VERSION;
  j["threads"] = thread_count(c.threads);
  j["elements"] = s.mesh.element_count;
  j["sample_points"] = s.mesh.points.size();
  j["patches"] = s.mesh.patches.size();
  j["element_size"] = double(s.mesh.element_size);
  j["patch_size"] = double(s.mesh.patch_size);
  j["stored_per_point"] = s.stored_per_point;
  j["shots"] = s.shots;
  j["rays"] = s.rays;
  j["power"] = {{"emitted", b.emitted},           {"absorbed", b.absorbed},
                {"specular", b.lost_to_specular}, {"escaped", b.escaped},
                {"unaccounted", b.unaccounted},   {"unshot", b.unshot}};
  j["seconds"] = {{"import", t.import}, {"build", t.build}, {"preprocess", r.seconds},
                  {"write", t.write},   {"total", t.total}, {"total_cpu", cpu_seconds()}};
  j["solution_mb"] = double(s.memory_bytes()) * 1e-6;
  j["peak_memory_mb"] = peak_memory_mb();
  j["seed"] = c.options.seed;
  j["up"] = up_json(up);
  j["is_complete"] = s.is_complete;
  j["end"] = end_name(s.end);
  return j.dump(2) + "\n";
}

// Writes an interrupted solution, which can be viewed but not used by --solution. Returns the exit
// status.
int leave_unfinished(const RadiosityCommand& c, const PreparedScene& scene,
                     const RadiosityResult& result, const RadiositySeconds& seconds,
                     const UpDecision& up) {
  const RadiositySolution& s = result.solution;
  Unfinished left;
  OutputSet files;
  for (const std::string& path : c.outputs)
    if (s.shots > 0)
      files.add(left.place(path), output_for(path, scene, s));
    else
      left.note(path, "");
  if (!c.stats.empty()) files.add(left.place(c.stats), statistics_json(c, result, seconds, up));
  files.commit();
  fmt::print(stderr, "interrupted after {} shots: {}{}\n", s.shots, left.text(),
             s.shots > 0 ? "; render does not accept an unfinished solution" : "");
  return exit_interrupted;
}

}  // namespace

void add_radiosity(CLI::App& app, RadiosityCommand& c) {
  CLI::App* s = app.add_subcommand("radiosity", "Compute the radiosity of a scene's surfaces");
  add_scene_choice(*s, c.scene);
  s->add_option("-o,--output", c.outputs,
                ".gltf or .glb: mesh and light for viewers; any other ending, such as .trad: "
                "solution for --solution; may be repeated")
      ->required()
      ->allow_extra_args(false);
  s->add_flag("--cells", c.makes_cells,
              "Compute cache cells of all surfaces instead, for --method certified and --solution "
              "of render and measure");
  s->add_option("--element-size", c.options.meshing.element_size,
                "Longest edge of an element, in metres [chosen for about 4000 elements]")
      ->check(number_above_zero());
  s->add_option("--patch-size", c.options.meshing.patch_size,
                "Longest edge of a patch, in metres [derived from the element size]")
      ->check(number_above_zero());
  s->add_option("--stored", c.options.stored_per_point,
                "Number of sources whose light is stored separately at each sample point")
      ->check(whole_number_between(0, max_stored))
      ->capture_default_str();
  s->add_option("--unshot", c.options.unshot_fraction,
                "Stop when the unshot power is less than this share of the direct light on diffuse "
                "surfaces")
      ->check(number_between(1e-6, 1))
      ->capture_default_str();
  add_light_choice(*s, c.lights);
  add_daylight_options(*s, c.daylight);
  add_threads(*s, c.threads);
  add_seed(*s, c.options.seed);
  s->add_option("--stats", c.stats, "JSON file for counts, times and settings");
  s->add_flag("--quiet", c.is_quiet, "No progress bar, notes, warnings or summary");
}

int run_radiosity(const RadiosityCommand& c) {
  const Clock::time_point start = Clock::now();
  check_command(c);
  OutputGuard guard;
  guard.add_inputs(c.scene, c.daylight);
  guard.add_outputs("-o", c.outputs);
  guard.add_output("--stats", c.stats);
  const std::vector<OutputReservation> reserved = reserve_outputs(c.outputs, c.stats);
  RadiositySeconds seconds;
  const ThreadLimit limit(c.threads);
  UpUse up;
  Scene imported = load_scene(c.scene, c.lights, &c.daylight, c.is_quiet, up);
  guard.check_files_read();
  seconds.import = seconds_since(start);
  Clock::time_point mark = Clock::now();
  const PreparedScene scene(std::move(imported));
  seconds.build = seconds_since(mark);

  const StopFlag& stop = install_stop_handlers();
  if (c.makes_cells) return make_cell_files(c, scene, stop);
  warn_of_lights_left_out(scene, c.is_quiet);
  RadiosityResult result;
  {
    ProgressBar bar("radiosity", c.is_quiet);
    result = preprocess(
        scene, c.options, c.threads, [&](double f) { bar.update(f); }, stop);
  }
  const RadiositySolution& s = result.solution;
  mark = Clock::now();
  if (s.end == RadiosityEnd::stopped)
    return leave_unfinished(c, scene, result, seconds, up.decision);
  OutputSet files;
  for (const std::string& path : c.outputs) files.add(path, output_for(path, scene, s));
  seconds.write = seconds_since(mark);
  seconds.total = seconds_since(start);
  if (!c.stats.empty()) files.add(c.stats, statistics_json(c, result, seconds, up.decision));
  files.commit();
  if (!c.is_quiet) {
    print_summary(result);
    std::fflush(stdout);
    for (const std::string& w : radiosity_warnings(s)) fmt::print(stderr, "warning: {}\n", w);
    std::vector<std::string> names = c.outputs;
    if (!c.stats.empty()) names.push_back(c.stats);
    tell_done(names, seconds.total, std::nullopt);
  }
  return exit_done;
}

}  // namespace troffer
