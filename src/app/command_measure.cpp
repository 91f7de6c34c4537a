#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/commands.h"
#include "app/output_guard.h"
#include "app/outputs.h"
#include "app/points_csv.h"
#include "app/printable.h"
#include "app/process.h"
#include "app/progress.h"
#include "app/signals.h"
#include "app/solution_file.h"
#include "app/unfinished.h"
#include "base/error.h"
#include "base/parallel.h"
#include "image/atomic_file.h"
#include "render/placement.h"

namespace troffer {

namespace {

// Warns of points whose place is hardly intended.
void tell_of_points(const PreparedScene& scene, const std::vector<MeasuringPoint>& points,
                    const MeasureResult& result) {
  if (!result.in_surfaces.empty())
    fmt::print(stderr,
               "warning: {} of {} points (the first is number {}) lie exactly in another surface; "
               "measured just in front of it\n",
               result.in_surfaces.size(), points.size(), result.in_surfaces.front() + 1);
  for (const std::string& text : misplaced_points(scene, points, result))
    fmt::print(stderr, "warning: {}\n", text);
}

void guard_files(const MeasureCommand& c, const MeasureOptions& options, OutputGuard& guard) {
  guard.add_inputs(c.scene, c.daylight);
  guard.add_input("--points", c.points);
  guard.add_output("-o", c.output);
  if (needs_cells(options.method, options.indirect))
    guard.add_output("--solution", c.solution);
  else
    guard.add_input("--solution", c.solution);
}

void write_csv(const std::string& path, const std::string& csv) {
  if (path.empty())
    std::fputs(csv.c_str(), stdout);
  else
    write_file(path, csv);
}

// Returns the root mean square of the standard errors, relative to the mean illuminance.
double relative_error(const std::vector<Measurement>& values) {
  double squares = 0, sum = 0;
  for (const Measurement& m : values) {
    squares += m.standard_error * m.standard_error;
    sum += m.illuminance_lx;
  }
  const auto n = double(values.size());
  return sum > 0 ? std::sqrt(squares / n) / (sum / n) : 0;
}

// Writes the results and returns the exit status.
int write_points(const MeasureCommand& c, const PointList& list, const MeasureResult& result,
                 Clock::time_point start) {
  const std::string csv = measurements_csv(list, result);
  if (result.is_complete) {
    write_csv(c.output, csv);
    if (c.is_quiet) return exit_done;
    std::fflush(stdout);
    const std::vector<std::string> files(c.output.empty() ? 0 : 1, c.output);
    tell_done(files, seconds_since(start), relative_error(result.values));
    return exit_done;
  }
  const auto finished = std::count(result.is_measured.begin(), result.is_measured.end(), true);
  Unfinished left;
  if (finished > 0 && c.output.empty())
    write_csv("", csv);
  else if (finished > 0)
    write_csv(left.place(c.output), csv);
  else if (!c.output.empty())
    left.note(c.output, "");
  fmt::print(stderr, "interrupted after {} of {} points: {}\n", finished, list.points.size(),
             finished > 0 && c.output.empty() ? "these were printed" : left.text());
  return exit_interrupted;
}

}  // namespace

int run_measure(const MeasureCommand& c) {
  const Clock::time_point start = Clock::now();
  MeasureOptions options;
  options.method = parse_method(c.method);
  options.indirect = c.indirect;
  check_method(options.method, options.indirect, c.solution);
  options.spp = c.spp;
  options.depth = c.depth;
  options.error = c.error;
  options.threads = c.threads;
  options.seed = c.seed;
  if (options.method.row().is_direct_only && options.indirect != Indirect::none && !c.is_quiet)
    fmt::print(stderr, "warning: --method {} measures direct light only\n", c.method);
  OutputGuard guard;
  guard_files(c, options, guard);
  std::vector<OutputReservation> reserved = reserve_outputs({}, c.output);
  reserve_cells(c.solution, options.method, options.indirect, reserved);
  const bool asks_for_none = c.points.empty() && c.grid.grids.empty();
  if (asks_for_none && !may_have_sensor_grids(c.scene.file))
    throw UsageError("measure: give --points FILE.csv or --grid NODE");
  PointList list = c.points.empty() ? PointList{} : read_points(c.points);
  if (!c.is_quiet && !list.note.empty()) fmt::print(stderr, "note: {}\n", printable(list.note));
  const ThreadLimit limit(c.threads);
  UpUse up{!c.grid.grids.empty(), {}};
  Scene imported = load_scene(c.scene, c.lights, &c.daylight, c.is_quiet, up);
  guard.check_files_read();
  const PreparedScene scene(std::move(imported));
  warn_of_misplaced(scene, c.is_quiet);
  if (asks_for_none)
    add_sensor_grids(scene.scene, list);
  else
    add_grids(scene, c.grid, up.decision.up, list);
  const std::vector<MeasuringPoint>& points = list.points;

  const StopFlag& stop = install_stop_handlers();
  const std::unique_ptr<Preparation> preparation =
      prepare_method(scene, options.method, options.kj92, options.indirect, c.solution, c.threads,
                     c.is_quiet, stop);
  options.preparation = preparation.get();
  const std::unique_ptr<CellStore> cells =
      cells_of_file(scene, options.method, options.indirect, c.solution);
  options.cells = cells.get();
  MeasureResult result;
  {
    ProgressBar bar("measure", c.is_quiet);
    result = measure(
        scene, points, options, [&](double f) { bar.update(f); }, stop);
  }
  if (!c.is_quiet && result.counters.nan_samples > 0)
    fmt::print(stderr, "warning: {} samples were not finite and count as 0\n",
               result.counters.nan_samples);
  if (!c.is_quiet) tell_of_points(scene, points, result);
  keep_cells(scene, cells.get(), c.solution, c.is_quiet);
  return write_points(c, list, result, start);
}

}  // namespace troffer
