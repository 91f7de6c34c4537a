#include "app/command_annual.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "annual/annual_page.h"
#include "annual/annual_text.h"
#include "annual/extras_text.h"
#include "annual/path_scenes.h"
#include "app/annual_sink.h"
#include "app/common_options.h"
#include "app/grid_points.h"
#include "app/option_values.h"
#include "app/output_guard.h"
#include "app/points_csv.h"
#include "app/printable.h"
#include "app/process.h"
#include "app/progress.h"
#include "app/report_folder.h"
#include "app/signals.h"
#include "base/error.h"
#include "base/parallel.h"
#include "image/atomic_file.h"
#include "render/placement.h"
#include "report/groups.h"

namespace troffer {

namespace {

// Files in the output folder.
std::vector<std::string> output_files(const AnnualCommand& c) {
  std::vector<std::string> names{"annual.html", "annual.json", "metrics.csv"};
  if (!c.eyes.empty()) names.push_back("glare.csv");
  if (!c.electric.empty()) names.push_back("electric.csv");
  return names;
}

constexpr const char* honeybee = "honeybee";  // folder within the output folder

// Consecutive points of one surface form a grid.
std::vector<AnnualGrid> grids_of(const AnnualCommand& c, const PointList& list) {
  std::vector<AnnualGrid> grids;
  for (size_t i = 0; i < list.points.size(); ++i) {
    const std::string name = list.surfaces.empty() || list.surfaces[i].empty()
                                 ? std::filesystem::path(c.points).stem().string()
                                 : list.surfaces[i];
    if (grids.empty() || grids.back().name != name) grids.push_back({name, i, 0, {}, {}, {}});
    ++grids.back().count;
  }
  return grids;
}

std::vector<std::string> notes_of(const Scene& scene, const WeatherYear& year, bool has_electric) {
  std::vector<std::string> notes;
  if (year.filled > 0)
    notes.push_back(
        fmt::format("{} of {} hours of the weather file lack irradiances and got those "
                    "of the nearest day",
                    year.filled, year.steps.size()));
  if (!scene.lights.empty() && !has_electric)
    notes.push_back(
        fmt::format("the {} light sources of the scene are off: the year is daylight "
                    "alone",
                    scene.lights.size()));
  return notes;
}

void guard_outputs(const AnnualCommand& c, OutputGuard& guard) {
  guard.add_inputs(c.scene, {});
  guard.add_input("--points", c.points);
  guard.add_input("--weather", c.weather);
  guard.add_input("--groups", c.groups);
  guard.add_input("--eyes", c.eyes);
  guard.add_input("--sunlight", c.sunlight);
  if (c.lasting.is_part()) return;
  for (const std::string& name : output_files(c))
    guard.add_output("-o", (std::filesystem::path(c.output) / name).string());
}

// Largest error of a grid's mean illuminance, relative to it.
double error_of_means(const AnnualReport& report) {
  double largest = 0;
  for (const AnnualGrid& g : report.grids)
    for (const GridFigure& f : g.result.figures)
      if (f.key == "mean_lx" && f.figure.value > 0)
        largest = std::max(largest, f.figure.error / f.figure.value);
  return largest;
}

void write_outputs(const AnnualCommand& c, const AnnualReport& report, const ReportFolder& folder,
                   HoneybeeFolder& arrays, Clock::time_point start) {
  arrays.finish(report.year, report.result.skies, report.result.schedule);
  write_file(folder.file("metrics.csv"), annual_metrics(report));
  if (!c.eyes.empty()) write_file(folder.file("glare.csv"), glare_csv(report));
  if (!c.electric.empty()) write_file(folder.file("electric.csv"), electric_csv(report));
  write_file(folder.file("annual.json"), annual_json(report));
  write_file(folder.file("annual.html"), annual_page(report));
  if (c.is_quiet) return;
  std::vector<std::string> written;
  for (const std::string& name : output_files(c)) written.push_back(folder.file(name));
  tell_done(written, seconds_since(start), error_of_means(report));
}

bool uses_grids_of_model(const AnnualCommand& c) {
  return c.points.empty() && c.grid.grids.empty();
}

// Reads --points, if given. Throws UsageError if there can be no sensors at all.
PointList points_of(const AnnualCommand& c) {
  if (uses_grids_of_model(c) && !may_have_sensor_grids(c.scene.file))
    throw UsageError("annual: give --points FILE.csv or --grid NODE");
  PointList list = c.points.empty() ? PointList{} : read_points(c.points);
  if (!c.is_quiet && !list.note.empty()) fmt::print(stderr, "note: {}\n", printable(list.note));
  return list;
}

// Points of --eyes and --sunlight.
std::vector<MeasuringPoint> listed_points(const std::string& file) {
  return file.empty() ? std::vector<MeasuringPoint>{} : read_points(file).points;
}

// Computes what needs no hours of sensors: sunlight and electric light.
void add_sunlight(const AnnualCommand& c, const std::vector<LightPath>& paths,
                  const WeatherYear& year, const Compass& compass, AnnualExtras& extras) {
  extras.sunlight_day = parse_sunlight_day(c.sunlight_day);
  const std::vector<MeasuringPoint> points = listed_points(c.sunlight);
  const std::vector<double> hours =
      sunlight_hours(paths, points, year, compass, extras.sunlight_day, c.options.threads);
  for (size_t i = 0; i < points.size(); ++i) extras.sunlight.push_back({points[i], hours[i]});
}

void add_extra_options(CLI::App& s, AnnualCommand& c) {
  s.add_option("--eyes", c.eyes,
               "CSV file with columns x,y,z,nx,ny,nz: eyes and their lines of sight, rated for "
               "glare in every hour");
  s.add_option("--sunlight", c.sunlight,
               "CSV file with columns x,y,z,nx,ny,nz: points whose exposure to sunlight is found");
  s.add_option("--sunlight-day", c.sunlight_day,
               "Day of --sunlight, and from which altitude of the sun on, in degrees [0]")
      ->capture_default_str();
  s.add_option("--electric", c.electric,
               "Group of light sources that daylight dims; '*' stands for any letters; may be "
               "repeated")
      ->allow_extra_args(false);
  s.add_option("--electric-target", c.electric_target_lx,
               "Illuminance that daylight and --electric reach together, in lx")
      ->check(number_between(1, 100000))
      ->capture_default_str();
}

// Everything that a run reads and prepares before it computes.
struct AnnualInputs {
  PointList list;
  std::vector<MeasuringPoint> eyes;
  WeatherYear year;
  Compass compass;
  std::vector<std::string> notes;
  std::vector<ElectricGroup> electric;
  Scene lit;  // with its lights, for electric groups
  std::vector<LightPath> paths;
  std::vector<AnnualGrid> grids;
};

AnnualInputs read_inputs(const AnnualCommand& c, OutputGuard& guard) {
  guard_outputs(c, guard);
  AnnualInputs in;
  in.list = points_of(c);
  in.year = read_weather_year(c.weather);
  in.eyes = listed_points(c.eyes);
  parse_sunlight_day(c.sunlight_day);  // mistakes show before any work
  UpUse up{true, {}};
  Scene imported = load_scene(c.scene, {}, nullptr, c.is_quiet, up);
  guard.check_files_read();
  in.notes = notes_of(imported, in.year, !c.electric.empty());
  if (!c.is_quiet)
    for (const std::string& n : in.notes) fmt::print(stderr, "note: {}\n", n);
  in.compass = make_compass(up.decision.up, c.north_deg, is_mirrored(imported));
  in.electric = electric_groups(imported, c.electric);
  if (!in.electric.empty()) in.lit = imported;
  in.paths = annual_paths({c.scene.file, c.scene.options}, imported, c.groups);
  if (uses_grids_of_model(c))
    add_sensor_grids(imported, in.list);
  else
    add_grids(PreparedScene(with_lights_off(std::move(imported))), c.grid, up.decision.up, in.list);
  in.grids = grids_of(c, in.list);
  return in;
}

// Adds what follows from the hours of all sensors.
void finish_extras(const AnnualCommand& c, const AnnualInputs& in, const AnnualResult& result,
                   const DimmingYear& dimming, AnnualExtras& extras) {
  for (EyeYear& e : extras.eyes) e.shares = shares_of_glare(e.dgp, result.times);
  add_sunlight(c, in.paths, in.year, in.compass, extras);
  extras.electric = dimming.use(result.times, in.year.steps_per_hour);
}

}  // namespace

void add_annual(CLI::App& app, AnnualCommand& c) {
  CLI::App* s = app.add_subcommand("annual", "Compute a year of daylight and its metrics");
  add_scene_choice(*s, c.scene);
  s->add_option("--weather", c.weather, "Weather file: .epw, or Radiance's .wea")->required();
  s->add_option("-o,--output", c.output, "Folder for tables, page and hourly arrays");
  s->add_option("--points", c.points, "CSV file with columns x,y,z,nx,ny,nz");
  s->add_option("--grid", c.grid.grids,
                "Grid of points over the upward surface of a node, with the height above it and "
                "the spacing in metres [0; spacing by EN 12464-1]; may be repeated")
      ->allow_extra_args(false);
  s->add_option("--border", c.grid.border,
                "Width of the strip without points along the edge of --grid, in metres")
      ->check(number_between(0, 1000))
      ->capture_default_str();
  s->add_option("--north", c.north_deg,
                "Direction of north, in degrees clockwise as seen from above, from -z (from +y if "
                "z is up)")
      ->check(number_between(-360, 360))
      ->capture_default_str();
  s->add_option("--ground", c.options.ground_reflectance, "Reflectance of the ground below a sky")
      ->check(number_between(0, 1))
      ->capture_default_str();
  s->add_option("--occupancy", c.options.occupancy,
                "Occupied hours of every day, or a file with one number per hour of the year, of "
                "which 0 means unoccupied")
      ->capture_default_str();
  s->add_option("--groups", c.groups,
                "Window groups and their states, for scenes other than HBJSON");
  s->add_option("--blinds", c.options.blinds,
                "Operation of window groups: lm-83 (closed against sun), open, or a table with a "
                "column of states per group and a row per time step")
      ->capture_default_str();
  add_extra_options(*s, c);
  s->add_option("--threshold", c.options.figures.da_lx,
                "Illuminance of daylight autonomy and sDA, in lx")
      ->check(number_between(1, 100000))
      ->capture_default_str();
  s->add_option("--subdivision", c.options.subdivision,
                "Fineness of the sky for light straight from it: 144 N² + 1 patches")
      ->check(whole_number_between(1, 8))
      ->capture_default_str();
  s->add_option("--gather-rays", c.options.rays_of_sensor,
                "Rays that gather reflected light at a sensor [128 to 2048, by their number]")
      ->check(whole_number_between(8, 1 << 20));
  s->add_flag("--ill", c.writes_ill, "Also write hourly arrays as text: .ill beside .npy");
  s->add_option("--title", c.title, "Title of the page [name of the scene file]");
  add_annual_lasting(*s, c.lasting);
  add_threads(*s, c.options.threads);
  add_seed(*s, c.options.seed);
  s->add_flag("--quiet", c.is_quiet, "No progress bar, notes or warnings");
}

int run_annual(const AnnualCommand& c, const std::string& command_line) {
  const Clock::time_point start = Clock::now();
  const ThreadLimit limit(c.options.threads);
  if (c.output.empty() && !c.lasting.is_part()) throw UsageError("annual: give -o FOLDER");
  OutputGuard guard;
  AnnualStore store(c.lasting, guard);
  AnnualInputs in = read_inputs(c, guard);
  std::vector<MeasuringPoint> points = in.list.points;
  points.insert(points.end(), in.eyes.begin(), in.eyes.end());
  AnnualRequest request{in.paths, points, {}, in.year, in.compass, in.eyes.size(), nullptr};
  for (const AnnualGrid& g : in.grids) request.grids.push_back({g.first, g.count});
  store.begin(request, c.options, c.is_quiet);
  const StopFlag& stop = install_stop_handlers();
  if (c.lasting.is_part()) return store.run_part(request, c.options, c.is_quiet, stop);
  const ReportFolder folder(c.output);
  AnnualExtras extras;
  extras.electric_target_lx = c.electric_target_lx;
  for (const MeasuringPoint& eye : in.eyes) extras.eyes.push_back({eye, {}, {}, {}});
  extras.lights = measure_electric(in.lit, in.electric, in.list.points, c.options.seed,
                                   c.options.threads, stop);
  DimmingYear dimming(extras.lights, c.electric_target_lx);
  AnnualSink sink(folder.file(honeybee), c.writes_ill ? ArrayFormat::npy_and_ill : ArrayFormat::npy,
                  in.paths, in.grids, extras.eyes, dimming);
  ProgressBar bar("annual", c.is_quiet);
  const AnnualResult result = compute_annual(
      request, c.options, [&](size_t sensor, const HoursOfSensor& h) { sink.take(sensor, h); },
      [&](double f) { bar.update(f); }, stop);
  if (!result.is_complete || sink.arrays() == nullptr) return store.end_early();
  for (AnnualGrid& g : in.grids)
    g.result = grid_result(result.figures, g.first, g.count, !result.times.mornings.empty(),
                           has_several_states(in.paths));
  finish_extras(c, in, result, dimming, extras);
  const std::string name = std::filesystem::path(c.scene.file).filename().string();
  const AnnualReport report{c.title.empty() ? name : c.title,
                            c.scene.file,
                            c.weather,
                            TROFFER_VERSION,
                            command_line,
                            in.notes,
                            c.options.occupancy,
                            c.options.blinds,
                            c.options.figures.da_lx,
                            c.north_deg,
                            c.options.subdivision,
                            in.year,
                            in.compass,
                            in.list.points,
                            result,
                            in.grids,
                            in.paths,
                            std::move(extras)};
  write_outputs(c, report, folder, *sink.arrays(), start);
  store.remove();
  return exit_done;
}

}  // namespace troffer
