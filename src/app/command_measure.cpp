#include <fmt/format.h>

#include <cstdio>

#include "app/commands.h"
#include "app/outputs.h"
#include "app/points_csv.h"
#include "app/progress.h"
#include "app/signals.h"
#include "app/solution_file.h"
#include "base/error.h"
#include "base/parallel.h"
#include "image/atomic_file.h"
#include "render/placement.h"

namespace troffer {

namespace {

// Where points stand as they cannot be meant to.
void tell_of_points(const PreparedScene& scene, const std::vector<MeasuringPoint>& points,
                    const MeasureResult& result) {
  if (!result.in_surfaces.empty())
    fmt::print(stderr,
               "warning: {} of {} points (the first is number {}) stand exactly in a surface that "
               "is not theirs; measured just before its front\n",
               result.in_surfaces.size(), points.size(), result.in_surfaces.front() + 1);
  for (const std::string& text : misplaced_points(scene, points, result))
    fmt::print(stderr, "warning: {}\n", text);
}

}  // namespace

int run_measure(const MeasureCommand& c) {
  MeasureOptions options;
  options.method = parse_method(c.method);
  options.indirect = indirect_with(c.solution, options.method, c.indirect);
  check_method(options.method, options.indirect, c.solution);
  options.spp = c.spp;
  options.depth = c.depth;
  options.error = c.error;
  options.threads = c.threads;
  options.seed = c.seed;
  if (options.method.row().is_direct_only && options.indirect != Indirect::none && !c.is_quiet)
    fmt::print(stderr, "warning: --method {} measures direct light only\n", c.method);
  std::vector<OutputReservation> reserved = reserve_outputs({}, c.output);
  reserve_cells(c.solution, options.method, options.indirect, reserved);
  if (c.points.empty() && c.grid.grids.empty())
    throw UsageError("measure: give --points FILE.csv or --grid NODE");
  PointList list = c.points.empty() ? PointList{} : read_points(c.points);
  const ThreadLimit limit(c.threads);
  UpUse up{!c.grid.grids.empty(), {}};
  const PreparedScene scene(load_scene(c.scene, c.lights, &c.daylight, c.is_quiet, up));
  warn_of_misplaced(scene, c.is_quiet);
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
  if (result.is_complete) keep_cells(scene, cells.get(), c.solution, c.is_quiet);
  const std::string csv = measurements_csv(list, result);
  if (c.output.empty())
    std::fputs(csv.c_str(), stdout);
  else
    write_file(c.output, csv);
  if (!result.is_complete) {
    fmt::print(stderr, "interrupted: wrote the points that were finished\n");
    return exit_interrupted;
  }
  return exit_done;
}

}  // namespace troffer
