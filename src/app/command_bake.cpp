#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>

#include "app/commands.h"
#include "app/common_options.h"
#include "app/daylight_flags.h"
#include "app/option_values.h"
#include "app/output_guard.h"
#include "app/outputs.h"
#include "app/printable.h"
#include "app/process.h"
#include "app/progress.h"
#include "app/signals.h"
#include "app/solution_file.h"
#include "app/unfinished.h"
#include "bake/bake.h"
#include "base/error.h"
#include "base/parallel.h"
#include "export/export_scene.h"
#include "export/output_folder.h"
#include "image/encode.h"

namespace troffer {

namespace {

BakedShading shading_of(const BakeCommand& c) {
  if (int(c.has_vertex_colors) + int(c.is_unlit) + int(c.is_emissive) > 1)
    throw UsageError("--vertex-colours, --unlit and --emissive exclude each other: give one");
  return c.has_vertex_colors ? BakedShading::vertex_colors
         : c.is_unlit        ? BakedShading::unlit
         : c.is_emissive     ? BakedShading::emissive
                             : BakedShading::lightmap;
}

// Checks everything that can be checked before any work.
BakeOptions options_of(const BakeCommand& c) {
  const std::string ending = std::filesystem::path(c.output).extension().string();
  if (ending != ".gltf" && ending != ".glb")
    throw UsageError("cannot write " + c.output + ": its name should end in .gltf or .glb");
  if (!std::isfinite(c.error)) throw UsageError("--error: not a number");
  if (!std::isfinite(c.texels_per_metre)) throw UsageError("--texels-per-metre: not a number");
  check_exposure(c.exposure);
  BakeOptions o;
  o.shading = shading_of(c);
  o.atlas = {c.texels_per_metre, c.resolution, c.largest_page, c.gutter};
  o.samples = c.spp;
  if (c.exposure != "auto" && !c.exposure.empty())
    o.exposure_stops = std::strtod(c.exposure.c_str(), nullptr);
  o.light.method = parse_method(c.method);
  o.light.indirect = parse_indirect(c.indirect);
  check_method(o.light.method, o.light.indirect, c.solution);
  o.light.depth = c.depth;
  o.light.error = c.error;
  o.light.threads = c.threads;
  o.light.seed = c.seed;
  return o;
}

// Writes the pages' irradiance in lx next to the scene. Returns the file names, with the names for
// the scene's notes.
std::map<std::string, std::string> write_pages(const BakeCommand& c, BakeResult& result,
                                               OutputFolder& files) {
  std::map<std::string, std::string> written;
  if (c.hdr == "none" || result.irradiance.empty()) return written;
  std::string names;
  for (size_t i = 0; i < result.irradiance.size(); ++i) {
    const std::string name = fmt::format("light{}.{}", i, c.hdr);
    if (c.hdr == "exr") {
      const std::vector<Layer> layers{{"", {"R", "G", "B"}, std::move(result.irradiance[i])},
                                      {"error", {"V"}, std::move(result.error[i])}};
      written[name] =
          files.write(name, encode_exr(layers, {}, "irradiance in lx, its standard error"));
    } else {
      written[name] = files.write(name, encode_hdr(result.irradiance[i]));
    }
    names += fmt::format("{}\"{}\"", i > 0 ? "," : "", written[name]);
  }
  result.baked.notes.emplace_back("irradiance_lx", "[" + names + "]");
  return written;
}

void tell(const BakeResult& result, const std::vector<Warning>& lost) {
  for (const std::vector<Warning>* list : {&result.warnings, &lost})
    for (const Warning& w : *list) {
      fmt::print(stderr, "warning: {}", printable(w.text));
      if (w.count > 1) fmt::print(stderr, " ({} times)", w.count);
      fmt::print(stderr, "\n");
    }
  if (result.counters.nan_samples > 0)
    fmt::print(stderr, "warning: {} samples were not finite and count as 0\n",
               result.counters.nan_samples);
  const BakeFigures& f = result.figures;
  if (result.atlas.size > 0)
    fmt::print(
        "{} page{} of {} x {} texels, {:.3g} per metre, {} of them lit; {} charts on {} "
        "surfaces\n",
        result.atlas.pages, result.atlas.pages == 1 ? "" : "s", result.atlas.size,
        result.atlas.size, result.atlas.texels_per_metre, f.sites, f.charts, f.stands);
  else
    fmt::print("{} vertices on {} surfaces\n", f.sites, f.stands);
  fmt::print("mean illuminance {:.4g} lx, standard error of a {} {:.2g} lx ({:.2g} %)\n", f.mean_lx,
             result.atlas.size > 0 ? "texel" : "vertex", f.error_lx,
             f.mean_lx > 0 ? 100 * f.error_lx / f.mean_lx : 0.0);
}

void guard_files(const BakeCommand& c, const BakeOptions& options, OutputGuard& guard) {
  guard.add_inputs(c.scene, c.daylight);
  guard.add_output("-o", c.output);
  if (needs_cells(options.light.method, options.light.indirect))
    guard.add_output("--solution", c.solution);
  else
    guard.add_input("--solution", c.solution);
}

int run_bake(const BakeCommand& c, BakeOptions options) {
  const Clock::time_point start = Clock::now();
  OutputGuard guard;
  guard_files(c, options, guard);
  std::vector<OutputReservation> reserved = reserve_outputs({c.output}, "");
  reserve_cells(c.solution, options.light.method, options.light.indirect, reserved);
  const ThreadLimit limit(c.threads);
  UpUse up{true, {}};
  Scene imported = load_scene(c.scene, c.lights, &c.daylight, c.is_quiet, up);
  guard.check_files_read();
  const PreparedScene scene(as_meshes(std::move(imported)));
  warn_of_misplaced(scene, c.is_quiet);
  const StopFlag& stop = install_stop_handlers();
  const std::unique_ptr<Preparation> preparation =
      prepare_method(scene, options.light.method, options.light.kj92, options.light.indirect,
                     c.solution, c.threads, c.is_quiet, stop);
  options.light.preparation = preparation.get();
  const std::unique_ptr<CellStore> cells =
      cells_of_file(scene, options.light.method, options.light.indirect, c.solution);
  options.light.cells = cells.get();
  BakeResult result;
  {
    ProgressBar bar("bake", c.is_quiet);
    if (!stop)
      result = bake(
          scene, options, [&](double f) { bar.update(f); }, stop);
  }
  keep_cells(scene, cells.get(), c.solution, c.is_quiet);
  if (!result.is_complete) {
    Unfinished left;
    left.note(c.output, "");
    fmt::print(stderr, "interrupted: {}\n", left.text());
    return exit_interrupted;
  }
  OutputFolder files(c.output);
  const std::map<std::string, std::string> pages = write_pages(c, result, files);
  const std::vector<Warning> lost =
      export_scene(std::move(result.scene), c.output, &result.baked, up.decision.up, &files);
  for (const auto& [name, reference] : pages) files.link(name, reference);
  if (c.is_quiet) return exit_done;
  tell(result, lost);
  std::fflush(stdout);
  tell_done({c.output}, seconds_since(start),
            result.figures.mean_lx > 0 ? result.figures.error_lx / result.figures.mean_lx : 0);
  return exit_done;
}

void add_texel_options(CLI::App* s, BakeCommand& c) {
  s->add_option("--texels-per-metre", c.texels_per_metre,
                "Texels per metre of surface [as many as fill one page of --resolution]")
      ->check(number_between(1e-3, 1e4));
  s->add_option("--resolution", c.resolution, "Texels along the side of a single page")
      ->check(whole_number_between(16, 16384))
      ->capture_default_str();
  s->add_option("--max-size", c.largest_page,
                "Texels along the side of the largest page; the rest goes on further pages")
      ->check(whole_number_between(64, 16384))
      ->capture_default_str();
  s->add_option("--gutter", c.gutter, "Texels around each chart that repeat its edge")
      ->check(whole_number_between(1, 64))
      ->capture_default_str();
}

}  // namespace

void add_bake(CLI::App& app, BakeCommand& c) {
  CLI::App* s = app.add_subcommand("bake", "Compute lightmaps for game engines and the web");
  add_scene_choice(*s, c.scene);
  s->add_option("-o,--output", c.output, "Scene to write, with its light: .gltf or .glb")
      ->required();
  add_texel_options(s, c);
  s->add_flag("--vertex-colours,--vertex-colors", c.has_vertex_colors,
              "Write the light as vertex colours, which multiply unlit base colours");
  s->add_flag("--unlit", c.is_unlit,
              "Write unlit materials that look lit, for viewers that compute no light");
  s->add_flag("--emissive", c.is_emissive,
              "Write black surfaces that emit the light they reflect, in cd/m2");
  s->add_option("--exposure", c.exposure,
                "Exposure of --unlit and --vertex-colours in stops, or auto")
      ->capture_default_str();
  s->add_option("--hdr", c.hdr,
                "Format of the irradiance image (lx) that is written beside the scene")
      ->check(one_of({"exr", "hdr", "none"}))
      ->capture_default_str();
  s->add_option("--spp", c.spp, "Samples per texel, or vertex")
      ->check(whole_number_between(4, 1 << 14))
      ->capture_default_str();
  add_method(*s, c.method);
  s->add_option("--error", c.error, "certified: allowed standard error of direct light")
      ->check(number_between(1e-6, 1))
      ->capture_default_str();
  add_indirect(*s, c.indirect);
  s->add_option("--depth", c.depth, "Maximum number of bounces: 1 is direct light only [no limit]")
      ->check(whole_number_between(0, 1 << 20));
  s->add_option("--solution", c.solution,
                "certified: file that stores cache cells; they are read if it exists, and new ones "
                "are added. certified and kj92: radiosity solution made by troffer radiosity");
  add_light_choice(*s, c.lights);
  add_daylight_options(*s, c.daylight);
  c.daylight.adds_default_sky = false;  // lightmaps hold measured values
  add_threads(*s, c.threads);
  add_seed(*s, c.seed);
  s->add_flag("--quiet", c.is_quiet, "No progress bar, notes, warnings or figures");
}

int check_and_bake(const CLI::App& command_line, BakeCommand command) {
  BakeOptions options = options_of(command);
  if (command_line.get_option("--texels-per-metre")->count() > 0 &&
      command_line.get_option("--resolution")->count() > 0)
    throw UsageError("--resolution and --texels-per-metre both set the texel size: give one");
  warn_of_unused_options(command_line, options.light.method, command.is_quiet);
  return run_bake(command, std::move(options));
}

}  // namespace troffer
