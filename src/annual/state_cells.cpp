#include "annual/state_cells.h"

#include <algorithm>

namespace troffer {

namespace {

// Largest size of a cell that a long ray sees, over the ray's length (cells/cell_map.h).
constexpr float size_by_distance = 1.0f / 32;

}  // namespace

StateCells::StateCells(const TransportCells& shared, const PreparedScene& scene,
                       const RayRegions& regions, size_t region, const TransportRays& rays,
                       uint64_t seed, int threads, const StopFlag& stop)
    : shared_(shared),
      regions_(regions),
      region_(region),
      walks_(scene, nullptr),
      map_(scene.tracer, shared.map().size_of_cells()),
      places_(seed) {
  more_of_sensors_ = differences(shared.sensor_log(), shared.sensors().size(), threads, stop);
  near_ = map_.size();
  // Rays of cells that sensors see start where sensors see them, as those of shared cells do.
  trace_rows(rays, near_, 1, seed, threads, stop);
  more_of_rows_ = differences(shared.row_log(), shared.rows().size(), threads, stop);
  trace_rows(rays, most_transport_cells, most_cell_rounds, seed, threads, stop);
  while (rows_.size() < map_.size()) rows_.add_empty();
  is_grey_ = shared.is_grey() && are_grey(rows_.cells) && are_grey(more_of_rows_.cells) &&
             are_grey(more_of_sensors_.cells);
}

// Returns the cell of each hit. Shared cells that reach into the region are none of the state's: a
// surface of the state may divide them. Own cells replace them.
std::vector<uint32_t> StateCells::cells_of(const CellsSeen& seen) {
  std::vector<uint32_t> cells;
  for (const CellSeen& s : seen.seen) {
    uint32_t cell = no_cell;
    const float reach = std::max(shared_.map().size_of_cells(), s.distance * size_by_distance);
    if (!regions_.holds(region_, s.hit.position, reach))
      cell = shared_.map().find(s.hit, s.distance);
    if (cell == no_cell) {
      const uint32_t own = map_.add(s.hit, s.distance);
      places_.add(own, s.hit);
      cell = uint32_t(shared_.cell_count()) + own;
    }
    cells.push_back(cell);
  }
  return cells;
}

SightRows StateCells::differences(const RayLog& log, size_t rows, int threads,
                                  const StopFlag& stop) {
  const std::vector<CellTask> tasks = log.tasks(region_);
  CellsSeen seen;
  seen.keeps_escapes = true;
  Counters counters;
  trace_cell_rays(walks_, nullptr, tasks, threads, nullptr, stop, seen, counters);
  SightRows after;
  add_rows(seen, tasks, cells_of(seen), nullptr, after);
  return log.differences(region_, after, rows);
}

// Traces the rows of own cells below number `end_of_all`, and of those that they see, for so many
// rounds.
void StateCells::trace_rows(const TransportRays& rays, size_t end_of_all, int rounds, uint64_t seed,
                            int threads, const StopFlag& stop) {
  CellsSeen seen;
  seen.keeps_escapes = true;
  Counters counters;
  for (int round = 0; round < rounds && !stop.load(); ++round) {
    const size_t end = std::min(map_.size(), end_of_all);
    if (rows_.size() == end) break;
    while (rows_.size() < end && !stop.load()) {
      const size_t first = rows_.size();
      const CellTasks next(places_, first, std::min(end - first, cell_tasks_at_a_time));
      const std::vector<CellTask> tasks = next.tasks(rays, near_, seed, shared_.cell_count());
      trace_cell_rays(walks_, nullptr, tasks, threads, nullptr, stop, seen, counters);
      std::vector<float> scales;
      add_rows(seen, tasks, cells_of(seen), &scales, rows_);
    }
  }
}

}  // namespace troffer
