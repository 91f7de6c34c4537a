#include "integrate/cell_builder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"
#include "integrate/cell_direct.h"
#include "integrate/cell_rays.h"
#include "integrate/pilot_places.h"
#include "integrate/uneven_cells.h"

namespace troffer {

namespace {

// All measured: docs/cells.md.
constexpr float size_of_median = 0.06f;  // of a cell, of the median length of gather rays …
constexpr double fine_error = 0.05;      // … for errors up to this; larger ones take larger cells
constexpr double size_by_error = 0.58, most_coarseness = 4;
constexpr size_t pilot_rays = 1 << 17;  // gather rays from what the pilot sees
constexpr uint32_t rays_of_row = 16;    // first ones of a cell that matters
constexpr uint32_t rays_of_step = 8;    // further ones come in so many
// A cell's first rays are each worth as much as this many of the pilot's, all bounces counted, for
// `fine_error`; for others by this power of the error.
constexpr double pilots_of_ray = 0.1, worth_by_error = 1.5;
// A cell with fewer first rays than this gets its light straight from sources by draws, this many
// for a ray.
constexpr uint32_t rays_for_proofs = 4, draws_of_ray = 2;
constexpr uint32_t most_rays_of_row = 4096;
constexpr double most_unresolved = 1e-5;  // of the light asked for, for an error of .01 or less
constexpr double enough_of_wanted = 1.5;  // further rays that a kept cell has: no more then
constexpr int most_rounds = 12;
constexpr size_t most_cells_of_map = 1 << 21;
constexpr size_t tasks_at_a_time = 1 << 14;
// By how many bounces importance is brought on where further rays are shared out, and where rows
// seem to be complete; and at a look at which cells lack them: what one look leaves the next takes
// up.
constexpr int bounces_of_importance = 24, bounces_of_look = 6;

using Clock = std::chrono::steady_clock;

// How many times what suits a fine one is asked.
double coarseness(double error, double fine) {
  return std::clamp(error / fine, 1.0, most_coarseness);
}

// What is asked for, by all that look at cells first.
struct Asked {
  size_t askers = 0;              // viewing rays, and points
  double of_ray = 0;              // importance that a cell's ray is worth
  std::vector<PilotHit> seen;     // by gather rays
  std::vector<float> light;       // per cell
  std::vector<float> importance;  // per cell, all bounces counted, as last looked at
};

class Builder {
 public:
  Builder(const PreparedScene& scene, const DirectLight& direct, const CellBuilderOptions& options,
          CellStore* store, const StopFlag& stop, Counters& counters)
      : scene_(scene),
        walks_(scene, direct.images()),
        options_(options),
        stop_(stop),
        counters_(counters),
        store_(store) {}

  void ask(const CellPilot& pilot);
  // False once stopped, or where cells are too many.
  bool make_rows(const std::function<void(double)>& progress);
  std::unique_ptr<Cells> finish(const DirectLight& direct, Clock::time_point start);

 private:
  void start_map(const CellsSeen& seen);
  bool add_direct(const DirectLight& direct, CellDirectLight& lit);
  void keep(const CellDirectLight& lit);
  void note(const std::vector<CellTask>& tasks, CellsSeen& seen);
  bool run(const std::vector<CellTask>& tasks);
  std::span<const CellHit> hits_of(const CellTask& task) const;
  CellTask task_of(uint32_t cell, uint32_t first, uint32_t count) const;
  std::vector<uint32_t> cells_to_resolve(int bounces);
  uint32_t first_rays(uint32_t cell) const;
  void add_first_tasks(uint32_t cell, uint32_t had, uint32_t count, std::vector<CellTask>& tasks);
  std::vector<CellTask> first_tasks();
  std::vector<CellTask> further_tasks();

  const PreparedScene& scene_;
  GatherWalks walks_;
  CellBuilderOptions options_;
  const StopFlag& stop_;
  Counters& counters_;
  CellStore* store_;  // null: nothing is kept
  std::shared_ptr<CellMap> map_;
  CellRows rows_;
  Asked asked_;
  size_t entries_kept_ = 0;  // of rows_, from the store
  CellStatistics statistics_;
};

// What is kept, or an empty map of cells as large as suits what was seen.
void Builder::start_map(const CellsSeen& seen) {
  if (store_ != nullptr && store_->map) {
    map_ = std::make_shared<CellMap>(*store_->map);
    map_->freeze();
    rows_ = std::move(store_->rows);
    entries_kept_ = rows_.entry_count();
    return;
  }
  std::vector<float> lengths;
  for (const CellSeen& c : seen.seen) lengths.push_back(c.distance);
  const auto middle = lengths.begin() + std::ptrdiff_t(lengths.size() / 2);
  if (!lengths.empty()) std::nth_element(lengths.begin(), middle, lengths.end());
  const float median = lengths.empty() ? 0 : *middle;
  const float size =
      size_of_median * float(std::pow(coarseness(options_.error, fine_error), size_by_error));
  // Finer than this, voxels would be no larger than the rounding of positions.
  const Box box = bounds(scene_.scene);
  const float least = box.is_empty() ? 1.0f : std::max(1e-5f * box.diagonal(), least_cell);
  map_ = std::make_shared<CellMap>(scene_.tracer, std::max(size * median, least));
}

void Builder::ask(const CellPilot& pilot) {
  const std::vector<PilotPlace> places = places_of(pilot, walks_, counters_);
  asked_.askers = pilot.viewing.size() + pilot.places.size();
  std::vector<CellTask> tasks;
  const auto rays = uint32_t(
      std::clamp<size_t>(pilot_rays / std::max<size_t>(places.size(), 1), rays_of_row, 2048));
  for (uint32_t i = 0; i < places.size(); ++i) {
    if (places[i].is_gloss) continue;
    CellTask& t = tasks.emplace_back();
    t.count = rays;
    t.stream = hash_of(options_.seed, i, uint64_t{0x7069'6c6f});
    t.weight = places[i].weight / float(rays);
    t.from = {&places[i].hit, 1};
  }
  CellsSeen seen;
  trace_cell_rays(walks_, nullptr, tasks, options_.threads, options_.crew, stop_, seen, counters_);
  if (stop_.load()) seen.seen.clear();  // not all of them
  for (const PilotPlace& p : places) {
    if (!p.is_gloss) continue;
    seen.seen.push_back({uint32_t(tasks.size()), no_cell, p.distance, Rgb{1}, p.hit});
    tasks.emplace_back().weight = p.weight;
  }
  start_map(seen);
  map_->halve_where(uneven_cells(scene_));
  asked_.light.resize(map_->size(), 0);  // of a map that is kept too, where nothing is seen
  for (const CellSeen& c : seen.seen) {
    const uint32_t cell = map_->add(c.hit, c.distance, true);
    asked_.light.resize(map_->size(), 0);
    const float share = tasks[c.task].weight, weight = luminance(c.weight);
    asked_.light[cell] += share * weight;
    if (tasks[c.task].count > 0) asked_.seen.push_back({c.hit, cell, share, weight});
  }
  const double all = std::accumulate(asked_.light.begin(), asked_.light.end(), 0.0);
  const double error = std::clamp(options_.error, 1e-3, 0.2) / fine_error;
  asked_.of_ray = pilots_of_ray * std::pow(error, worth_by_error) * all / double(pilot_rays);
  rows_.finish(map_->size());
}

CellTask Builder::task_of(uint32_t cell, uint32_t first, uint32_t count) const {
  return {cell, first, count, hash_of(options_.seed, cell, uint64_t{0x726f'7773}), 1, {}};
}

// Every other step of a cell's rays; either half goes from its own half of the hits, so that what
// halves differ by tells of the choice of hits as well.
bool is_second_half(const CellTask& task) {
  return task.first / rays_of_step % 2 == 1;
}

std::span<const CellHit> Builder::hits_of(const CellTask& task) const {
  const std::span<const CellHit> hits = map_->hits(task.cell);
  if (hits.size() < 2) return hits;
  const size_t half = hits.size() / 2;
  return is_second_half(task) ? hits.subspan(half) : hits.first(half);
}

// New cells where there were none, and the rows.
void Builder::note(const std::vector<CellTask>& tasks, CellsSeen& seen) {
  std::vector<RowEntry> entries;
  size_t at = 0;
  for (uint32_t t = 0; t < tasks.size(); ++t) {
    entries.clear();
    for (; at < seen.seen.size() && seen.seen[at].task == t; ++at) {
      CellSeen& c = seen.seen[at];
      if (c.cell == no_cell) c.cell = map_->add(c.hit, c.distance);
      entries.push_back({c.cell, c.weight});
    }
    rows_.add({tasks[t].cell, tasks[t].count, 0, is_second_half(tasks[t]), seen.emission[t]},
              entries);
  }
  TROFFER_CHECK(at == seen.seen.size());
}

bool Builder::run(const std::vector<CellTask>& tasks) {
  CellsSeen seen;
  std::vector<CellTask> some;
  for (size_t first = 0; first < tasks.size(); first += tasks_at_a_time) {
    if (stop_.load(std::memory_order_relaxed)) return false;
    some.assign(tasks.begin() + std::ptrdiff_t(first),
                tasks.begin() + std::ptrdiff_t(std::min(first + tasks_at_a_time, tasks.size())));
    for (CellTask& t : some) t.from = hits_of(t);
    trace_cell_rays(walks_, map_.get(), some, options_.threads, options_.crew, stop_, seen,
                    counters_);
    if (stop_.load()) return false;
    note(some, seen);
  }
  asked_.light.resize(map_->size(), 0);
  rows_.finish(map_->size());
  return true;
}

// Cells without a row, the most important first, but for those that hardly matter.
std::vector<uint32_t> Builder::cells_to_resolve(int bounces) {
  asked_.importance = rows_.importance(asked_.light, std::move(asked_.importance), bounces);
  const std::vector<float>& y = asked_.importance;
  double all = 0, open = 0;
  std::vector<uint32_t> cells;
  for (uint32_t c = 0; c < y.size(); ++c) {
    all += double(y[c]);
    if (rows_.has_row(c)) continue;
    open += double(y[c]);
    cells.push_back(c);
  }
  statistics_.unresolved = all > 0 ? open / all : 0;
  const double most = most_unresolved * coarseness(options_.error, 0.01);
  if (statistics_.unresolved <= most || map_->size() > most_cells_of_map) return {};
  std::sort(cells.begin(), cells.end(),
            [&](uint32_t a, uint32_t b) { return y[a] != y[b] ? y[a] > y[b] : a < b; });
  double left = open;
  size_t kept = 0;
  while (kept < cells.size() && left > 0.5 * most * all) left -= double(y[cells[kept++]]);
  cells.resize(kept);
  return cells;
}

// By what a cell matters: where few rays share cells (in the open, between small things) 16 rays
// from each, and from what they hit, would be a tree without end; one from each is a path.
uint32_t Builder::first_rays(uint32_t cell) const {
  if (cell >= asked_.importance.size()) return 1;
  const double worth = double(asked_.importance[cell]) / asked_.of_ray;
  uint32_t n = rays_of_row;
  while (n > 1 && worth < n) n /= 2;
  return n;
}

// Of the first `count` rays of a cell those after the first `had`, either half of them from its own
// half of the sequence.
void Builder::add_first_tasks(uint32_t cell, uint32_t had, uint32_t count,
                              std::vector<CellTask>& tasks) {
  const auto add = [&](uint32_t first, uint32_t end, uint32_t begin) {
    if (end > first) tasks.push_back(task_of(cell, begin + first, end - first));
  };
  add((had + 1) / 2, (count + 1) / 2, 0);
  add(had / 2, count / 2, rays_of_step);
}

// Of cells without a row, and of those that have turned out to matter more than they have rays for:
// one whose few rays met itself, say, and would keep its light for ever.
std::vector<CellTask> Builder::first_tasks() {
  std::vector<CellTask> tasks;
  std::vector<uint32_t> cells = cells_to_resolve(bounces_of_look);
  if (cells.empty()) cells = cells_to_resolve(bounces_of_importance);
  for (const uint32_t c : cells) add_first_tasks(c, 0, first_rays(c), tasks);
  for (uint32_t c = 0; !tasks.empty() && c < asked_.importance.size(); ++c)
    if (rows_.has_row(c) && first_rays(c) >= 2 * rows_.rays(c))
      add_first_tasks(c, rows_.rays(c), first_rays(c), tasks);
  return tasks;
}

// As many rays again as the first ones of the cells that matter, in proportion to what is asked of
// them; less what they have had already, for other views.
std::vector<CellTask> Builder::further_tasks() {
  asked_.importance =
      rows_.importance(asked_.light, std::move(asked_.importance), bounces_of_importance);
  const std::vector<float>& y = asked_.importance;
  const double all = std::accumulate(y.begin(), y.end(), 0.0);
  std::vector<CellTask> tasks;
  if (!(all > 0)) return tasks;
  const double least = map_->frozen() > 0 ? 0.5 * most_unresolved * all / double(y.size()) : -1;
  size_t rays = 0;
  for (uint32_t c = 0; c < y.size(); ++c)
    if (rows_.has_row(c) && double(y[c]) > least) rays += std::min(rows_.rays(c), rays_of_row);
  const double steps = double(rays) / rays_of_step;
  for (uint32_t c = 0; c < y.size(); ++c) {
    if (!rows_.has_row(c)) continue;
    const double wanted =
        std::min(steps * double(y[c]) / all, double(most_rays_of_row / rays_of_step));
    const uint32_t first = std::min(rows_.rays(c), rays_of_row);
    if (first < rays_of_row && wanted < 0.5) continue;
    add_first_tasks(c, first, rays_of_row, tasks);
    const uint32_t had = (rows_.rays(c) - first) / rays_of_step;
    if (wanted < enough_of_wanted * had) continue;
    for (uint32_t step = had; step < uint32_t(wanted + 0.5); ++step)
      tasks.push_back(task_of(c, rays_of_row + step * rays_of_step, rays_of_step));
  }
  return tasks;
}

bool Builder::make_rows(const std::function<void(double)>& progress) {
  if (double(map_->size()) > options_.most_cells) return false;
  for (bool is_further : {false, true}) {
    for (int round = 0; round < most_rounds; ++round) {
      const std::vector<CellTask> tasks =
          is_further && round == 0 ? further_tasks() : first_tasks();
      if (tasks.empty()) break;
      if (!run(tasks) || double(map_->size()) > options_.most_cells) return false;
      ++statistics_.rounds;
      if (progress) progress(1 - 1 / (1.0 + 0.5 * statistics_.rounds));
    }
  }
  return !stop_.load();
}

// Light straight from sources, where it is not kept; false once stopped.
bool Builder::add_direct(const DirectLight& direct, CellDirectLight& lit) {
  size_t first = 0;
  if (map_->frozen() > 0 && store_->direct_error <= options_.direct_error) {
    lit = {std::move(store_->direct), std::move(store_->direct_half_difference)};
    first = map_->frozen();
  }
  // What is kept may matter more to the next view.
  std::vector<uint8_t> draws(map_->size(), 0);
  for (uint32_t c = 0; store_ == nullptr && c < draws.size(); ++c)
    if (first_rays(c) < rays_for_proofs) draws[c] = uint8_t(draws_of_ray * first_rays(c));
  add_direct_light(*map_, walks_, direct, draws, first, options_.threads, options_.crew, stop_, lit,
                   counters_);
  return !stop_.load();
}

// Hits are no longer needed but by those who go on from here.
void Builder::keep(const CellDirectLight& lit) {
  if (store_ == nullptr) return map_->forget_hits();
  const bool is_relit = map_->frozen() > 0 && store_->direct_error > options_.direct_error;
  store_->is_changed =
      map_->size() > map_->frozen() || rows_.entry_count() > entries_kept_ || is_relit;
  if (map_->frozen() == 0 || is_relit) store_->direct_error = options_.direct_error;
  store_->map = map_;
  store_->rows = std::move(rows_);
  store_->direct = lit.irradiance;
  store_->direct_half_difference = lit.half_difference;
}

std::unique_ptr<Cells> Builder::finish(const DirectLight& direct, Clock::time_point start) {
  CellDirectLight lit;
  if (!add_direct(direct, lit)) return nullptr;
  CellLight light = rows_.solve(lit.irradiance, lit.half_difference, std::move(asked_.importance),
                                options_.threads);
  statistics_.cells = map_->size();
  double sum = 0;
  for (size_t c = 0; c < asked_.light.size(); ++c)
    sum += double(asked_.light[c]) * double(luminance(light.irradiance[c]));
  statistics_.typical = sum / pi / double(std::max<size_t>(asked_.askers, 1));
  statistics_.entries = rows_.entry_count();
  statistics_.rays = rows_.ray_count();
  statistics_.iterations = light.iterations;
  statistics_.size = double(map_->size_of_cells());
  statistics_.bytes = double(map_->bytes()) + double(rows_.entry_count()) * sizeof(RowEntry);
  BrightPlaces bright(scene_.tracer, std::move(asked_.seen), light.irradiance,
                      map_->size_of_cells());
  keep(lit);
  statistics_.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return std::make_unique<Cells>(scene_, std::move(map_), std::move(lit.irradiance),
                                 std::move(light.irradiance), std::move(light.half_difference),
                                 statistics_, direct.images(), std::move(bright));
}

}  // namespace

std::unique_ptr<Cells> make_cells(const PreparedScene& scene, const DirectLight& direct,
                                  const CellPilot& pilot, const CellBuilderOptions& options,
                                  CellStore* store, const std::function<void(double)>& progress,
                                  const StopFlag& stop, Counters& counters) {
  const Clock::time_point start = Clock::now();
  Builder builder(scene, direct, options, store, stop, counters);
  builder.ask(pilot);
  if (!builder.make_rows(progress)) return nullptr;
  return builder.finish(direct, start);
}

}  // namespace troffer
