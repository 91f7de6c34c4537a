#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <new>

#include "app/command_annual.h"
#include "app/command_report.h"
#include "app/commands.h"
#include "app/common_options.h"
#include "app/daylight_flags.h"
#include "app/option_help.h"
#include "app/option_values.h"
#include "app/plain_numbers.h"
#include "app/printable.h"
#include "app/signals.h"
#include "app/usage_errors.h"
#include "base/error.h"
#include "base/suggestion.h"
#include "render/aov_rows.h"

namespace troffer {

namespace {

constexpr const char* solution_help =
    "certified: file that stores cache cells; they are read if it exists, and new ones are added. "
    "certified and kj92: radiosity solution made by troffer radiosity";

// Values as typed. They become options after parsing, where errors throw UsageError.
struct RawOptions {
  std::string size, crop, indirect = "auto";
  std::vector<std::string> aovs;
  int shadow_rays = -1;  // -1: default of the method
  std::string coherence = "on", selection = "on";
};

std::vector<int> integers(const std::string& text, char separator, size_t count,
                          const std::string& option, const std::string& form) {
  std::vector<int> values;
  const char* p = text.data();
  const char* end = p + text.size();
  while (values.size() < count) {
    int v = 0;
    const auto [next, error] = std::from_chars(p, end, v);
    if (error != std::errc()) break;
    values.push_back(v);
    p = next;
    if (p == end) break;
    if (*p++ != separator) break;
  }
  if (values.size() != count || p != end)
    throw UsageError(option + ": '" + printable(text) + "' is not " + form);
  return values;
}

// With 0 initial rays kj92 samples no source: the picture shows the radiosity solution.
void apply_shadow_rays(int asked, RenderOptions& o) {
  if (asked < 0) return;
  BintreeOptions& tree = o.kj92.sampling.tree;
  if (asked == 0) o.kj92.selection.is_restricted = true;
  o.shadow_rays = std::max(asked, 1);
  tree.initial_rays = std::max(asked, 1);
  tree.most_rays = std::max(tree.most_rays, tree.initial_rays);
}

void apply(const RawOptions& raw, RenderOptions& o) {
  if (!raw.size.empty()) {
    const auto v = integers(raw.size, 'x', 2, "--size", "WIDTHxHEIGHT in pixels, such as 640x480");
    constexpr int largest = 65536;
    if (v[0] < 1 || v[1] < 1 || v[0] > largest || v[1] > largest)
      throw UsageError("--size: each side must lie between 1 and 65536");
    if (int64_t(v[0]) * v[1] > (int64_t(1) << 28))
      throw UsageError("--size: more than 268 million pixels");
    o.width = v[0];
    o.height = v[1];
  }
  if (!raw.crop.empty()) {
    const auto v =
        integers(raw.crop, ',', 4, "--crop", "X0,Y0,X1,Y1 in pixels, such as 0,0,320,240");
    o.has_crop = true;
    std::copy(v.begin(), v.end(), o.crop.begin());
  }
  o.indirect = parse_indirect(raw.indirect);
  apply_shadow_rays(raw.shadow_rays, o);
  o.kj92.sampling.has_coherence = raw.coherence == "on";
  o.kj92.selection.is_enabled = raw.selection == "on";
  for (const std::string& name : raw.aovs) {
    const std::optional<Aov> aov = find_aov(name);
    if (!aov) throw UsageError("--aov: there is no layer '" + name + "'");
    if (std::find(o.aovs.begin(), o.aovs.end(), *aov) == o.aovs.end()) o.aovs.push_back(*aov);
  }
}

void add_kj92(CLI::App* r, RenderCommand& c, RawOptions& raw) {
  TreeSamplingOptions& sampling = c.options.kj92.sampling;
  BintreeOptions& tree = sampling.tree;
  const CLI::Validator change = number_between(0, 1);
  r->add_option("--variance", tree.allowed_variance,
                "Allowed standard error of a viewing ray, relative to the unoccluded light; 0: "
                "--most-rays everywhere")
      ->check(number_between(0, 1000))
      ->capture_default_str();
  r->add_option("--most-rays", tree.most_rays,
                "Maximum number of shadow rays per source and viewing ray")
      ->check(whole_number_between(1, 1 << 16))
      ->capture_default_str();
  r->add_option("--mean-change", tree.mean_change,
                "Also stop when the mean changes by less than this; 0: never")
      ->check(change)
      ->capture_default_str();
  r->add_option("--level-difference", tree.level_difference,
                "Number of levels by which neighbouring leaves of the bintree may differ")
      ->check(whole_number_between(0, 24))
      ->capture_default_str();
  r->add_option("--probe-rays", sampling.probe_rays,
                "Shadow rays to a strong source that seems fully hidden or fully visible")
      ->check(whole_number_between(1, 1 << 10))
      ->capture_default_str();
  r->add_option("--coherence", raw.coherence,
                "Reuse the sampling pattern of the previous viewing ray")
      ->check(one_of({"on", "off"}))
      ->capture_default_str();
  r->add_flag("--ratio", sampling.uses_ratio,
              "Multiply the sampled visible share by the exact unoccluded light");
  r->add_option(
       "--selection", raw.selection,
       "The radiosity solution selects the sources; off: all emitters are sources everywhere")
      ->check(one_of({"on", "off"}))
      ->capture_default_str();
  r->add_option(
       "--select", c.selected_lights,
       "Only these sources may be sampled; the light of all others counts as general radiosity")
      ->delimiter(',')
      ->allow_extra_args(false);
  r->add_option("--solution", c.solution, solution_help);
}

// Adds the options of camera and image size.
void add_camera(CLI::App* r, RenderCommand& c, RawOptions& raw) {
  r->add_option("--size", raw.size, "Image size in pixels [the scene's]");
  r->add_option("--crop", raw.crop,
                "Render only this window, in pixels from the top left; column X1 and row Y1 are "
                "not included");
  r->add_option("--camera", c.camera,
                "Name of the camera; troffer info lists the names [the first]");
  r->add_option("--eye", c.eye, "Position of the camera, instead of the scene's cameras");
  r->add_option("--target", c.target, "Point that --eye looks at");
  r->add_option("--fov", c.fov_deg,
                "Field of view of --eye in degrees, over the picture's shorter side")
      ->check(number_between(0.1, 179))
      ->capture_default_str();
}

void add_render(CLI::App& app, RenderCommand& c, RawOptions& raw) {
  CLI::App* r = app.add_subcommand("render", "Render a picture of a scene");
  add_scene_choice(*r, c.scene);
  r->add_option("-o,--output", c.outputs, "Picture to write: .exr .hdr .pfm .png; may be repeated")
      ->required()
      ->allow_extra_args(false);
  r->add_flag("--preview", c.has_preview,
              "Write a coarse picture to -o at once, and a better one every few seconds");
  add_method(*r, c.method);
  r->add_option("--spp", c.options.spp,
                "Viewing rays per pixel, before refinement; powers of two are stratified best")
      ->check(whole_number_between(1, 1 << 20))
      ->capture_default_str();
  r->add_option("--max-spp", c.options.max_spp,
                "Maximum number of viewing rays in a pixel that differs from its neighbours "
                "[certified: 512 times --spp, and 256 times on average over 8 x 8 pixels; with "
                "--indirect none 256 and 128, with radiosity 4; other methods: --spp]")
      ->check(whole_number_between(1, 1 << 20));
  r->add_option("--shadow-rays", raw.shadow_rays,
                "Shadow rays per source and viewing ray [64]; kj92: number of initial shadow rays "
                "[8], 0: no source is sampled")
      ->check(whole_number_between(0, 1 << 20));
  add_kj92(r, c, raw);
  r->add_option("--error", c.options.error,
                "certified: allowed standard error of a pixel, relative to its light")
      ->check(number_between(1e-6, 1))
      ->capture_default_str();
  add_indirect(*r, raw.indirect);
  r->add_option("--depth", c.options.depth,
                "Maximum number of bounces: 0 shows emission only, 1 adds direct light [no limit]")
      ->check(whole_number_between(0, 1 << 20));
  add_camera(r, c, raw);
  add_light_choice(*r, c.lights);
  add_threads(*r, c.options.threads);
  add_seed(*r, c.options.seed);
  r->add_option("--aov", raw.aovs, "Additional layers for .exr files")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(one_of(split_at(aov_names(), ',')));
  r->add_option(
      "--exposure", c.exposure,
      "Exposure of .png in stops, or auto [0; auto if the picture would be nearly black or white]");
  r->add_option("--tone-map", c.tone_map, "Tone curve of .png")
      ->check(one_of({"filmic", "none"}))
      ->capture_default_str();
  add_daylight_options(*r, c.daylight);
  add_lasting_options(*r, c.lasting);
  r->add_option("--stats", c.stats, "JSON file for counts, times, settings and the plan");
  r->add_flag("--explain", c.explains,
              "Print what the method chooses for this picture, the reason and the expected cost");
  r->add_flag("--quiet", c.is_quiet, "No progress bar, notes or warnings");
}

void add_measure(CLI::App& app, MeasureCommand& c, RawOptions& raw) {
  CLI::App* s = app.add_subcommand("measure", "Measure irradiance and illuminance at points");
  add_scene_choice(*s, c.scene);
  s->add_option("--points", c.points, "CSV file with columns x,y,z,nx,ny,nz");
  s->add_option("--grid", c.grid.grids,
                "Grid of points over the upward surface of a node, with the height above it and "
                "the spacing in metres [0; spacing by EN 12464-1]; or, by name or room, a sensor "
                "grid of an .hbjson; may be repeated")
      ->allow_extra_args(false);
  s->add_option("--border", c.grid.border,
                "Width of the strip without points along the edge of --grid, in metres")
      ->check(number_between(0, 1000))
      ->capture_default_str();
  s->add_option("-o,--output", c.output, "CSV file [standard output]");
  add_method(*s, c.method);
  s->add_option("--spp", c.spp, "Samples per point [4096; kj92: 256; certified: by --error]")
      ->check(whole_number_between(2, 1 << 26));
  s->add_option("--solution", c.solution, solution_help);
  s->add_option("--error", c.error,
                "certified: allowed standard error of a point, relative to its light")
      ->check(number_between(1e-6, 1))
      ->capture_default_str();
  s->add_option("--depth", c.depth, "Maximum number of bounces: 1 is direct light only [no limit]")
      ->check(whole_number_between(0, 1 << 20));
  add_indirect(*s, raw.indirect);
  add_light_choice(*s, c.lights);
  add_daylight_options(*s, c.daylight);
  c.daylight.adds_default_sky = false;  // no value may depend on a sky that nobody asked for
  add_threads(*s, c.threads);
  add_seed(*s, c.seed);
  s->add_flag("--quiet", c.is_quiet, "No progress bar, notes or warnings");
}

void add_info(CLI::App& app, InfoCommand& c) {
  CLI::App* s = app.add_subcommand("info", "List what a scene or luminaire file holds");
  add_scene_choice(*s, c.scene);
  s->add_option("--polar", c.polar,
                "File for the polar curves of an .ies or .ldt file: .svg or .png");
  s->add_flag("--json", c.is_json, "Print JSON");
}

// Runs `render` with the parsed options of the command `app`.
int check_and_run(const CLI::App& app, RenderCommand& render, const RawOptions& raw) {
  check_exposure(render.exposure);
  apply(raw, render.options);
  if (render.method != "kj92" && raw.shadow_rays == 0)
    throw UsageError("--shadow-rays 0 belongs to --method kj92");
  const Method method = parse_method(render.method);
  apply_lasting_options(render, app.get_option("--spp")->count() > 0);
  warn_of_unused_options(app, method, render.is_quiet);
  return run_render(std::move(render));
}

int check_and_run(const CLI::App& app, MeasureCommand& measure, const RawOptions& raw) {
  measure.indirect = parse_indirect(raw.indirect);
  const Method method = parse_method(measure.method);
  warn_of_unused_options(app, method, measure.is_quiet);
  return run_measure(measure);
}

// Handles `troffer help`, `troffer help COMMAND` and, for tools, `troffer help --json`.
std::string asked_help(const CLI::App& app, int argc, const char* const* argv) {
  if (argc < 3) return commands_help(app);
  if (argv[2] == std::string("--json")) return help_json(app);
  for (const CLI::App* c : app.get_subcommands({}))
    if (c->get_name() == argv[2]) return command_help(*c);
  throw UsageError(no_command(app, argv[2]));
}

// Returns the exit status if help or version was all that was asked for. Throws UsageError for
// mistakes. leads: this process prints.
std::optional<int> parse_or_help(CLI::App& app, int argc, const char* const* argv, bool leads) {
  if (argc < 2) {
    if (leads) std::fputs(commands_help(app).c_str(), stderr);
    return exit_usage;
  }
  if (argv[1] == std::string("help")) {
    const std::string text = asked_help(app, argc, argv);
    if (leads) std::fputs(text.c_str(), stdout);
    return exit_done;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() != 0) throw UsageError(usage_message(app, argc, argv, e));
    if (leads) app.exit(e);  // --help, --version
    return exit_done;
  }
  return std::nullopt;
}

int parse_and_run(int argc, const char* const* argv, ProcessGroup* group) {
  CLI::App app{"troffer renders rooms and measures their light."};
  app.set_version_flag("--version", std::string("troffer ") + TROFFER_VERSION);
  app.require_subcommand(1);
  RenderCommand render;
  CompareCommand compare;
  MeasureCommand measure;
  RadiosityCommand radiosity;
  InfoCommand info;
  ConvertCommand convert;
  MergeCommand merge;
  ViewCommand view;
  ReportCommand lighting;
  BakeCommand light;
  GlareCommand glare;
  AnnualCommand annual;
  RawOptions render_raw, measure_raw;
  add_render(app, render, render_raw);
  add_compare(app, compare);
  add_measure(app, measure, measure_raw);
  add_radiosity(app, radiosity);
  add_info(app, info);
  add_convert(app, convert);
  add_merge(app, merge);
  add_view(app, view);
  add_report(app, lighting);
  add_bake(app, light);
  add_glare(app, glare);
  add_annual(app, annual);
  require_plain_numbers(app);
  set_help(app);
  const bool leads = group == nullptr || group->leads();
  if (const std::optional<int> status = parse_or_help(app, argc, argv, leads)) return *status;
  render.options.group = group;
  if (app.got_subcommand("render"))
    return check_and_run(*app.get_subcommand("render"), render, render_raw);
  if (group != nullptr && !group->leads())
    return exit_done;  // the leading process does everything
                       // else alone
  if (app.got_subcommand("compare")) return run_compare(compare);
  if (app.got_subcommand("measure"))
    return check_and_run(*app.get_subcommand("measure"), measure, measure_raw);
  if (app.got_subcommand("radiosity")) return run_radiosity(radiosity);
  if (app.got_subcommand("view")) return run_view(view);
  if (app.got_subcommand("convert")) return run_convert(convert);
  if (app.got_subcommand("report")) {
    lighting.command_line = command_text(argc, argv);
    return run_report(lighting);
  }
  if (app.got_subcommand("annual")) return run_annual(annual, command_text(argc, argv));
  if (app.got_subcommand("bake")) return check_and_bake(*app.get_subcommand("bake"), light);
  if (app.got_subcommand("glare")) return run_glare(std::move(glare));
  if (app.got_subcommand("merge")) return run_merge(merge);
  return run_info(info);
}

int report(const char* text, int status) {
  std::string line = text;
  for (char& ch : line)  // keep it one line, whatever a file puts into a name
    if (static_cast<unsigned char>(ch) < 0x20) ch = ' ';
  std::fprintf(stderr, "error: %s\n", printable(line).c_str());
  return status;
}

// Reports a failure in the leading process and returns its status. Another process leaves the group
// and returns success, since a failing status would end the others.
int report(const char* text, int status, ProcessGroup* group) {
  if (group == nullptr || group->leads()) return report(text, status);
  group->leave(text);
  return exit_done;
}

}  // namespace

int run(int argc, const char* const* argv, ProcessGroup* group) {
  std::string command;
  for (int i = 0; i < argc; ++i) command += (i > 0 ? " " : "") + std::string(argv[i]);
  set_check_command(command);
  exit_on_stop_signals();
  try {
    const int status = parse_and_run(argc, argv, group);
    // Output may still be in the buffer: a full disk shows up here.
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
      throw EnvironmentError("cannot write to standard output");
    return status;
  } catch (const UsageError& e) {
    return report(e.what(), exit_usage, group);
  } catch (const std::bad_alloc&) {
    return report("out of memory", exit_bad_input, group);
  } catch (const std::exception& e) {  // InputError, EnvironmentError, threads, text formatting
    return report(e.what(), exit_bad_input, group);
  }
}

}  // namespace troffer
