#include "annual/transport_cells.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/streams.h"
#include "bsdf/bsdf.h"
#include "gather/cell_rays.h"

namespace troffer {

namespace {

// Cell size over the median length of gather rays. Larger than for pictures (gather/cell_builder),
// because sensors see means over many cells.
constexpr float size_of_median = 0.2f;
constexpr size_t tasks_at_a_time = 4096;
// Cells are followed this far; they then number a few per cent of all at most.
constexpr int most_rounds = 12;
constexpr size_t most_cells = size_t(1) << 20;
// Largest sum of a row. Rows of matte surfaces stay below one; roulette at gloss may exceed it.
constexpr float most_of_row = 0.99f;

// Makes one row per task of `seen`, which is ordered by task. cell_of: cell of a hit.
template <class CellOf>
void add_rows(const CellsSeen& seen, std::span<const CellTask> tasks, bool is_bounded,
              const CellOf& cell_of, LinkRows<CellLink>& rows, LinkRows<OutsideLink>& outside) {
  std::vector<CellLink> links;
  std::vector<OutsideLink> ways;
  size_t at = 0, way = 0;
  for (size_t t = 0; t < tasks.size(); ++t) {
    links.clear();
    ways.clear();
    const float share = 1.0f / float(tasks[t].count);
    for (; at < seen.seen.size() && seen.seen[at].task == t; ++at)
      links.push_back({cell_of(seen.seen[at]), seen.seen[at].weight * share});
    for (; way < seen.escapes.size() && seen.escapes[way].task == t; ++way)
      ways.push_back({seen.escapes[way].direction, seen.escapes[way].weight * share});
    std::sort(links.begin(), links.end(),
              [](const CellLink& a, const CellLink& b) { return a.cell < b.cell; });
    size_t kept = 0;
    Rgb sum{0};
    for (size_t i = 0; i < links.size(); ++i) {
      sum += links[i].weight;
      if (kept > 0 && links[kept - 1].cell == links[i].cell)
        links[kept - 1].weight += links[i].weight;
      else
        links[kept++] = links[i];
    }
    links.resize(kept);
    if (is_bounded && max_component(sum) > most_of_row)
      for (CellLink& l : links) l.weight *= most_of_row / max_component(sum);
    rows.add(links);
    outside.add(ways);
  }
}

float median_distance(const CellsSeen& seen) {
  std::vector<float> d;
  for (const CellSeen& s : seen.seen) d.push_back(s.distance);
  if (d.empty()) return 1;
  const auto middle = d.begin() + std::ptrdiff_t(d.size() / 2);
  std::nth_element(d.begin(), middle, d.end());
  return *middle;
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

TransportCells::TransportCells(const PreparedScene& scene, std::span<const CellHit> sensors,
                               const TransportRays& rays, uint64_t seed, int threads,
                               const StopFlag& stop)
    : scene_(scene), walks_(scene, nullptr), places_(seed) {
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
  const auto cell_of = [&](const CellSeen& s) {
    const uint32_t cell = cells_->add(s.hit, s.distance);
    places_.add(cell, s.hit);
    return cell;
  };
  add_rows(seen, tasks, false, cell_of, sensors_, sensors_outside_);
  near_ = cells_->size();

  for (int round = 0; round < most_rounds && !stop.load(); ++round) {
    const size_t end = cells_->size();
    if (rows_.size() == end || end > most_cells) break;
    while (rows_.size() < end && !stop.load()) {
      const size_t first = rows_.size(), last = std::min(end, first + tasks_at_a_time);
      tasks.clear();
      // Places change as further rays hit, so tasks have copies.
      std::vector<std::vector<CellHit>> from;
      for (size_t c = first; c < last; ++c) {
        const std::span<const CellHit> hits = places_.of(c);
        from.emplace_back(hits.begin(), hits.end());
      }
      for (size_t c = first; c < last; ++c) {
        CellTask& t = tasks.emplace_back();
        t.cell = uint32_t(c);
        t.count = uint32_t(c < near_ ? rays.of_near_cell : rays.of_far_cell);
        t.stream = hash_of(seed, uint64_t(c), stream::annual_rows);
        t.from = from[c - first];
      }
      trace_cell_rays(walks_, nullptr, tasks, threads, nullptr, stop, seen, counters);
      add_rows(seen, tasks, true, cell_of, rows_, rows_outside_);
    }
  }
  while (rows_.size() < cells_->size()) {
    rows_.add({});
    rows_outside_.add({});
  }
  for (const LinkRows<CellLink>* rows : {&sensors_, &rows_})
    for (const CellLink& l : rows->all())
      is_grey_ = is_grey_ && l.weight.r == l.weight.g && l.weight.g == l.weight.b;
}

float TransportCells::coat_factor(const CellHit& hit, float cosine) const {
  if (hit.coated == CellHit::uncoated) return 1;
  return coat_share(walks_.coat_at(hit), cosine);
}

}  // namespace troffer
