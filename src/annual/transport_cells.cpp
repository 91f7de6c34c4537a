#include "annual/transport_cells.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/streams.h"
#include "bsdf/bsdf.h"

namespace troffer {

namespace {

// Cell size over the median length of gather rays. Larger than for pictures (gather/cell_builder),
// because sensors see means over many cells.
constexpr float size_of_median = 0.2f;
float median_distance(const CellsSeen& seen) {
  std::vector<float> d;
  for (const CellSeen& s : seen.seen) d.push_back(s.distance);
  if (d.empty()) return 1;
  const auto middle = d.begin() + std::ptrdiff_t(d.size() / 2);
  std::nth_element(d.begin(), middle, d.end());
  return *middle;
}

// Returns the cell of each hit. Makes cells that do not exist yet.
std::vector<uint32_t> cells_of(const CellsSeen& seen, CellMap& map, CellPlaces& places) {
  std::vector<uint32_t> cells;
  for (const CellSeen& s : seen.seen) {
    cells.push_back(map.add(s.hit, s.distance));
    places.add(cells.back(), s.hit);
  }
  return cells;
}

}  // namespace

void CellPlaces::add(uint32_t cell, const CellHit& hit) {
  if (cell >= cells_.size()) cells_.resize(cell + 1);
  Places& p = cells_[cell];
  const uint64_t seen = p.seen++;
  // Reservoir sampling: each hit stays with the same probability.
  const uint64_t at =
      seen < hits_per_cell
          ? seen
          : hash_of(seed_, uint64_t(cell), seen, stream::annual_cell_places) % (seen + 1);
  if (at < hits_per_cell) p.hits[at] = hit;
}

float coat_factor_at(const GatherWalks& walks, const CellHit& hit, float cosine) {
  if (hit.coated == CellHit::uncoated) return 1;
  return coat_share(walks.coat_at(hit), cosine);
}

CellTasks::CellTasks(const CellPlaces& places, size_t first, size_t count) : first_(first) {
  for (size_t c = first; c < first + count; ++c) {
    const std::span<const CellHit> hits = places.of(c);
    from_.emplace_back(hits.begin(), hits.end());
  }
}

std::vector<CellTask> CellTasks::tasks(const TransportRays& rays, size_t near, uint64_t seed,
                                       size_t number) const {
  std::vector<CellTask> tasks;
  for (size_t i = 0; i < from_.size(); ++i) {
    const size_t cell = first_ + i;
    CellTask& t = tasks.emplace_back();
    t.cell = uint32_t(cell);
    t.count = uint32_t(cell < near ? rays.of_near_cell : rays.of_far_cell);
    t.stream = hash_of(seed, uint64_t(cell + number), stream::annual_rows);
    t.from = from_[i];
  }
  return tasks;
}

TransportCells::TransportCells(const PreparedScene& scene, std::span<const CellHit> sensors,
                               const TransportRays& rays, const RayRegions& regions, uint64_t seed,
                               int threads, const StopFlag& stop)
    : walks_(scene, nullptr), places_(seed) {
  std::vector<CellTask> tasks;
  for (size_t i = 0; i < sensors.size(); ++i) {
    CellTask& t = tasks.emplace_back();
    t.count = uint32_t(rays.of_sensor);
    t.stream = hash_of(seed, uint64_t(i), stream::annual_gather);
    t.from = sensors.subspan(i, 1);
  }
  CellsSeen seen;
  seen.keeps_escapes = true;
  Counters counters;
  trace_cell_rays(walks_, nullptr, tasks, threads, nullptr, stop, seen, counters);
  // Sizes differ between replicates by up to √2, so that the spread of replicates includes the
  // error by uniform light within cells.
  const double octave = Random(hash_of(seed, stream::annual_cell_places)).next_double() - 0.5;
  const float size = size_of_median * median_distance(seen) * float(std::exp2(octave));
  cells_ = std::make_unique<CellMap>(scene.tracer, std::max(size, least_cell));
  // A cell that reaches into a region is none of the state's, because a surface of the state may
  // divide it. Rays to all places of such cells see cells of the state.
  const RayRegions wide = regions.widened(cells_->size_of_cells());
  for (RayLog* log : {&sensor_log_, &row_log_}) log->begin(wide, !ends_all_walks(scene.scene));
  add_rows(seen, tasks, cells_of(seen, *cells_, places_), nullptr, sensors_);
  sensor_log_.add(walks_, tasks, {}, 0);
  near_ = cells_->size();
  trace_rows(rays, seed, threads, stop);
  see_log(sensor_log_, threads, stop);
  see_log(row_log_, threads, stop);
  is_grey_ = are_grey(sensors_.cells) && are_grey(rows_.cells);
}

void TransportCells::trace_rows(const TransportRays& rays, uint64_t seed, int threads,
                                const StopFlag& stop) {
  CellsSeen seen;
  seen.keeps_escapes = true;
  Counters counters;
  for (int round = 0; round < most_cell_rounds && !stop.load(); ++round) {
    const size_t end = cells_->size();
    if (rows_.size() == end || end > most_transport_cells) break;
    while (rows_.size() < end && !stop.load()) {
      const size_t first = rows_.size();
      const CellTasks next(places_, first, std::min(end - first, cell_tasks_at_a_time));
      const std::vector<CellTask> tasks = next.tasks(rays, near_, seed, 0);
      trace_cell_rays(walks_, nullptr, tasks, threads, nullptr, stop, seen, counters);
      std::vector<float> scales;
      add_rows(seen, tasks, cells_of(seen, *cells_, places_), &scales, rows_);
      row_log_.add(walks_, tasks, scales, first);
    }
  }
  while (rows_.size() < cells_->size()) rows_.add_empty();
}

// Finds what the rays of a log see in this scene.
void TransportCells::see_log(RayLog& log, int threads, const StopFlag& stop) const {
  const std::vector<CellTask> tasks = log.tasks();
  CellsSeen seen;
  seen.keeps_escapes = true;
  Counters counters;
  trace_cell_rays(walks_, cells_.get(), tasks, threads, nullptr, stop, seen, counters);
  std::vector<uint32_t> cells;
  for (const CellSeen& s : seen.seen) cells.push_back(s.cell);
  SightRows rows;
  add_rows(seen, tasks, cells, nullptr, rows);
  log.set_seen(std::move(rows));
}

}  // namespace troffer
