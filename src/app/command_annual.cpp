#include "app/command_annual.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "annual/annual_page.h"
#include "annual/annual_text.h"
#include "annual/honeybee_folder.h"
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
#include "scene/scaled_lights.h"

namespace troffer {

namespace {

constexpr std::array output_files{"annual.html", "annual.json", "metrics.csv"};
constexpr const char* honeybee = "honeybee";  // folder within the output folder
constexpr float bright_lx = 300;              // AnnualGrid::share_300

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

// Adds a sensor's hours to the means of its grid.
void add_to_grid(const HoursOfSensor& hours, AnnualGrid& grid) {
  grid.mean_lx.resize(hours.total.size(), 0);
  grid.share_300.resize(hours.total.size(), 0);
  const float share = 1.0f / float(grid.count);
  for (size_t h = 0; h < hours.total.size(); ++h) {
    grid.mean_lx[h] += share * hours.total[h];
    grid.share_300[h] += hours.total[h] >= bright_lx ? 100 * share : 0;
  }
}

std::vector<std::string> notes_of(const Scene& scene, const WeatherYear& year) {
  std::vector<std::string> notes;
  if (year.filled > 0)
    notes.push_back(
        fmt::format("{} of {} hours of the weather file lack irradiances and got those "
                    "of the nearest day",
                    year.filled, year.steps.size()));
  if (!scene.lights.empty())
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
  for (const char* name : output_files)
    guard.add_output("-o", (std::filesystem::path(c.output) / name).string());
}

Scene dark(Scene scene) {
  const std::vector<Rgb> off(scene.lights.size(), Rgb{0});
  return with_scaled_lights(std::move(scene), off);
}

int tell_stopped() {
  fmt::print(stderr, "interrupted: nothing was written\n");
  return exit_interrupted;
}

void write_outputs(const AnnualCommand& c, const AnnualReport& report, const ReportFolder& folder,
                   HoneybeeFolder& arrays, Clock::time_point start) {
  arrays.finish(report.year, report.result.skies);
  write_file(folder.file("metrics.csv"), annual_metrics(report));
  write_file(folder.file("annual.json"), annual_json(report));
  write_file(folder.file("annual.html"), annual_page(report));
  if (c.is_quiet) return;
  std::vector<std::string> written;
  for (const char* name : output_files) written.push_back(folder.file(name));
  tell_done(written, seconds_since(start), report.result.relative_error);
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

}  // namespace

void add_annual(CLI::App& app, AnnualCommand& c) {
  CLI::App* s = app.add_subcommand("annual", "Compute a year of daylight and its metrics");
  add_scene_choice(*s, c.scene);
  s->add_option("--weather", c.weather, "Weather file: .epw, or Radiance's .wea")->required();
  s->add_option("-o,--output", c.output, "Folder for tables, page and hourly arrays")->required();
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
  s->add_option("--title", c.title, "Title of the page [name of the scene file]");
  add_threads(*s, c.options.threads);
  add_seed(*s, c.options.seed);
  s->add_flag("--quiet", c.is_quiet, "No progress bar, notes or warnings");
}

int run_annual(const AnnualCommand& c, const std::string& command_line) {
  const Clock::time_point start = Clock::now();
  OutputGuard guard;
  guard_outputs(c, guard);
  PointList list = points_of(c);
  const WeatherYear year = read_weather_year(c.weather);
  const ThreadLimit limit(c.options.threads);
  UpUse up{true, {}};
  Scene imported = load_scene(c.scene, {}, nullptr, c.is_quiet, up);
  guard.check_files_read();
  std::vector<std::string> notes = notes_of(imported, year);
  if (!c.is_quiet)
    for (const std::string& n : notes) fmt::print(stderr, "note: {}\n", n);
  const Compass compass = make_compass(up.decision.up, c.north_deg, is_mirrored(imported));
  const PreparedScene scene(dark(std::move(imported)));
  if (uses_grids_of_model(c))
    add_sensor_grids(scene.scene, list);
  else
    add_grids(scene, c.grid, up.decision.up, list);
  const std::vector<MeasuringPlace> places = measuring_places(scene, list.points);
  std::vector<AnnualGrid> grids = grids_of(c, list);

  const ReportFolder folder(c.output);
  const StopFlag& stop = install_stop_handlers();
  std::unique_ptr<HoneybeeFolder> arrays;
  size_t grid = 0;
  std::vector<HoneybeeGrid> named;
  for (const AnnualGrid& g : grids) named.push_back({g.name, g.count});
  const auto take = [&](size_t sensor, const HoursOfSensor& hours) {
    if (!arrays)
      arrays = std::make_unique<HoneybeeFolder>(folder.file(honeybee), named, hours.total.size());
    while (sensor >= grids[grid].first + grids[grid].count) ++grid;
    add_to_grid(hours, grids[grid]);
    arrays->add(hours);
  };
  ProgressBar bar("annual", c.is_quiet);
  const AnnualResult result = compute_annual(
      scene, places, year, compass, c.options, take, [&](double f) { bar.update(f); }, stop);
  if (!result.is_complete || !arrays) return tell_stopped();
  for (AnnualGrid& g : grids)
    g.result = grid_result(result.figures, g.first, g.count, !result.times.mornings.empty());
  const std::string name = std::filesystem::path(c.scene.file).filename().string();
  const AnnualReport report{c.title.empty() ? name : c.title,
                            c.scene.file,
                            c.weather,
                            TROFFER_VERSION,
                            command_line,
                            notes,
                            c.options.occupancy,
                            c.options.figures.da_lx,
                            c.north_deg,
                            c.options.subdivision,
                            year,
                            compass,
                            list.points,
                            result,
                            std::move(grids)};
  write_outputs(c, report, folder, *arrays, start);
  return exit_done;
}

}  // namespace troffer
