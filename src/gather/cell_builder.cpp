#include "gather/cell_builder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "base/ablation.h"
#include "base/error.h"
#include "base/random.h"
#include "base/streams.h"
#include "base/units.h"
#include "gather/cell_direct.h"
#include "gather/cell_rays.h"
#include "gather/pilot_places.h"
#include "gather/row_plan.h"
#include "gather/uneven_cells.h"

namespace troffer {

namespace {

// All measured: docs/log/cells.md.
constexpr float size_of_median = 0.06f;  // cell size over median ray length, for fine errors
constexpr double size_by_error = 0.58;   // power of the error by which cells are larger above those
// Cells with fewer first rays than this get direct light from light samples, not from certificates:
// this many samples per ray.
constexpr uint32_t rays_for_proofs = 4, draws_of_ray = 2;
// Asked error of a cell's direct light over that of the picture. Every pixel averages a hundred
// cells or more, and a third of the asked error is left to their noise.
constexpr double cells_of_mean = 10.0 / 3;
constexpr int most_rounds = 12;
constexpr size_t tasks_at_a_time = 1 << 14;
// Least factor by which points must need more rays of cells for these to be traced.
constexpr double enough_times_more = 1.5;
constexpr size_t refining_tasks_at_a_time = 1 << 16;

using Clock = std::chrono::steady_clock;

// Everything that the pilot's gather rays have seen.
struct PilotResult {
  size_t askers = 0;           // viewing rays and points
  std::vector<PilotHit> seen;  // hits, one task after the other
  std::vector<size_t> end;     // end of each task in `seen`
  uint32_t rays = 0;           // per task
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
        store_(store),
        plan_(rows_, options.error, options.seed) {}

  void ask(const CellPilot& pilot);
  // False if stopped, or if there are too many cells.
  bool make_rows(const std::function<void(double)>& progress);
  std::unique_ptr<Cells> finish(const DirectLight& direct, const CellPilot& pilot,
                                Clock::time_point start);

 private:
  void start_map(const CellsSeen& seen);
  bool add_direct(const DirectLight& direct, CellDirectLight& lit);
  void keep(const CellDirectLight& lit);
  void note(const std::vector<CellTask>& tasks, CellsSeen& seen);
  bool run(const std::vector<CellTask>& tasks);
  CellLighting lighting_by(const DirectLight& direct) const {
    return {walks_, direct, stop_, options_.seed, options_.threads, options_.group};
  }
  bool has_enough() const { return options_.enough != nullptr && options_.enough->load(); }
  std::span<const CellHit> hits_of(const CellTask& task) const;
  bool run_and_go_on(std::vector<CellTask> tasks, double most_cells,
                     const std::function<void(double)>& progress);
  bool refine(double times);
  double rays_for_points(const DirectLight& direct, const CellPilot& pilot,
                         const CellDirectLight& lit, const CellLight& light);

  const PreparedScene& scene_;
  GatherWalks walks_;
  CellBuilderOptions options_;
  const StopFlag& stop_;
  Counters& counters_;
  CellStore* store_;  // null: nothing is kept
  std::shared_ptr<CellMap> map_;
  CellRows rows_;
  RowPlan plan_;
  PilotResult asking_;
  size_t entries_kept_ = 0;  // number of entries of rows_ that the store had
  CellStatistics statistics_;
};

// Takes the map of the store, or makes an empty one with a cell size that suits what was seen.
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
      size_of_median *
      float(std::pow(coarseness(options_.error, RowPlan::fine_error), size_by_error));
  // Smaller voxels would be no larger than the rounding of positions.
  const Box box = bounds(scene_.scene);
  const float least = box.is_empty() ? 1.0f : std::max(1e-5f * box.diagonal(), least_cell);
  map_ = std::make_shared<CellMap>(scene_.tracer, std::max(size * median, least));
}

void Builder::ask(const CellPilot& pilot) {
  const std::vector<PilotPlace> places = places_of(pilot, walks_, counters_);
  asking_.askers = pilot.viewing.size() + pilot.places.size();
  std::vector<CellTask> tasks;
  const auto rays = uint32_t(std::clamp<size_t>(
      RowPlan::pilot_rays / std::max<size_t>(places.size(), 1), RowPlan::rays_of_row, 2048));
  const uint32_t sets = options_.points.most_rays > 0 ? PointsSeen::sets : 1;
  for (uint32_t i = 0; i < places.size(); ++i)
    for (uint32_t k = 0; k < sets && !places[i].is_gloss; ++k) {
      CellTask& t = tasks.emplace_back();
      t.count = rays / sets;
      t.stream = hash_of(options_.seed, i + k * uint32_t(places.size()), stream::cell_pilot_rays);
      t.weight = places[i].weight / float(sets * t.count);
      t.from = {&places[i].hit, 1};
    }
  asking_.rays = rays / sets;
  const size_t tasks_of_rays = tasks.size();
  CellsSeen seen;
  trace_cell_rays(walks_, nullptr, tasks, options_.threads, options_.group, stop_, seen, counters_);
  if (stop_.load()) seen.seen.clear();  // incomplete
  for (const PilotPlace& p : places) {
    if (!p.is_gloss) continue;
    seen.seen.push_back({uint32_t(tasks.size()), no_cell, p.distance, Rgb{1}, p.hit});
    tasks.emplace_back().weight = p.weight;
  }
  start_map(seen);
  map_->resolve_narrow(options_.points.most_rays > 0, options_.threads);
  map_->halve_where(uneven_cells(scene_));
  for (const CellSeen& c : seen.seen) {
    const uint32_t cell = map_->add(c.hit, c.distance, true);
    const float share = tasks[c.task].weight, weight = luminance(c.weight);
    plan_.ask(cell, share * weight);
    if (tasks[c.task].count == 0) continue;
    asking_.end.resize(c.task, asking_.seen.size());
    asking_.seen.push_back({c.hit, cell, share, weight});
  }
  asking_.end.resize(tasks_of_rays, asking_.seen.size());
  plan_.see(map_->size());  // includes kept cells that the pilot does not see
  plan_.end_asking();
  rows_.finish(map_->size());
}

std::span<const CellHit> Builder::hits_of(const CellTask& task) const {
  const std::span<const CellHit> hits = map_->hits(task.cell);
  if (hits.size() < 2) return hits;
  const size_t half = hits.size() / 2;
  return task.is_second_half ? hits.subspan(half) : hits.first(half);
}

// Adds cells for hits without one, and the rows.
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
    rows_.add({tasks[t].cell, tasks[t].count, 0, tasks[t].is_second_half, seen.emission[t]},
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
    trace_cell_rays(walks_, map_.get(), some, options_.threads, options_.group, stop_, seen,
                    counters_);
    if (stop_.load()) return false;
    note(some, seen);
    if (has_enough()) break;
  }
  plan_.see(map_->size());
  rows_.finish(map_->size());
  return true;
}

// Traces these tasks and then, round by round, first rays of all cells that need them. False if
// stopped, or if there are too many cells.
bool Builder::run_and_go_on(std::vector<CellTask> tasks, double most_cells,
                            const std::function<void(double)>& progress) {
  for (int round = 1; !tasks.empty(); ++round) {
    if (!run(tasks) || double(map_->size()) > most_cells) return false;
    ++statistics_.rounds;
    if (progress) progress(1 - 1 / (1.0 + 0.5 * statistics_.rounds));
    if (round == most_rounds || has_enough()) break;
    tasks = plan_.first_tasks();
  }
  return !stop_.load();
}

// Traces first rays, and then about as many further ones by importance.
bool Builder::make_rows(const std::function<void(double)>& progress) {
  const double most = options_.most_cells;
  if (double(map_->size()) > most || !run_and_go_on(plan_.first_tasks(), most, progress))
    return false;
  if (is_left_out<"further cell rays">()) return true;
  return has_enough() || run_and_go_on(plan_.further_tasks(map_->frozen()), most, progress);
}

// Traces rays until there are `times` as many. Cells of sub-cell features get none, because gather
// rays do not read them.
bool Builder::refine(double times) {
  std::vector<CellTask> tasks = plan_.refining_tasks(times * double(rows_.ray_count()));
  std::erase_if(tasks, [&](const CellTask& t) { return map_->is_narrow(t.cell); });
  for (size_t begin = 0; begin < tasks.size(); begin += refining_tasks_at_a_time) {
    if (map_->size() > RowPlan::most_cells) break;
    const size_t end = std::min(begin + refining_tasks_at_a_time, tasks.size());
    if (!run({tasks.begin() + std::ptrdiff_t(begin), tasks.begin() + std::ptrdiff_t(end)}))
      return false;
  }
  return run_and_go_on(plan_.first_tasks(), std::numeric_limits<double>::infinity(), nullptr);
}

// Returns how many times as many rays the cells should have for the points. Noise of cells on
// sub-cell features does not count, because gather rays do not read these.
double Builder::rays_for_points(const DirectLight& direct, const CellPilot& pilot,
                                const CellDirectLight& lit, const CellLight& light) {
  if (options_.points.most_rays <= 0 || store_ != nullptr) return 1;
  PointsSeen points{asking_.rays, {}, asking_.end};
  for (const PilotHit& h : asking_.seen) points.seen.push_back({h.cell, h.weight});
  std::vector<float> straight;
  for (const Rgb& e : direct_light_at(pilot.places, lighting_by(direct), counters_))
    straight.push_back(luminance(e));
  CellErrors off{rows_.differences(light.irradiance, options_.threads), lit.half_difference};
  for (uint32_t c = 0; c < map_->size(); ++c)
    if (map_->is_narrow(c)) off.by_rows[c] = off.by_hits[c] = 0;
  const PointsNoise noise = noise_at_points(points, straight, rows_, light.irradiance, off,
                                            options_.points, options_.seed, options_.threads);
  return times_as_many_rays(noise, double(rows_.ray_count()));
}

// Adds direct light where the store has none of the asked error; false if stopped.
bool Builder::add_direct(const DirectLight& direct, CellDirectLight& lit) {
  size_t first = lit.irradiance.size();
  if (first == 0 && map_->frozen() > 0 && store_->direct_error <= options_.direct_error) {
    lit = {std::move(store_->direct), std::move(store_->direct_half_difference)};
    first = map_->frozen();
  }
  // Kept cells all get full direct light, because they may matter more to the next view.
  std::vector<uint16_t> draws(map_->size(), 0);
  // The noise of cells is shared by all that see them; measuring points cannot average it out.
  uint32_t each = 0;
  if (store_ == nullptr && options_.points.most_rays <= 0 &&
      !is_left_out<"sampled light of cells">())
    each = samples_instead_of_proofs(*map_, lighting_by(direct),
                                     {options_.error * cells_of_mean, options_.rays_for_direct},
                                     counters_);
  for (uint32_t c = 0; store_ == nullptr && c < draws.size(); ++c) {
    const uint32_t rays = plan_.first_rays(c);
    if (each > 0 || (rays < rays_for_proofs && !is_left_out<"sampled light of small cells">()))
      draws[c] = uint16_t(std::max(draws_of_ray * rays, each * rays / RowPlan::rays_of_row));
  }
  add_direct_light(*map_, lighting_by(direct), draws, first, lit, counters_);
  return !stop_.load();
}

// Moves the results to the store. Without one the hits are freed, since only further views need
// them.
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

std::unique_ptr<Cells> Builder::finish(const DirectLight& direct, const CellPilot& pilot,
                                       Clock::time_point start) {
  CellDirectLight lit;
  const auto solve = [&] {
    return rows_.solve(lit.irradiance, lit.half_difference, plan_.importance(), options_.threads);
  };
  if (!add_direct(direct, lit)) return nullptr;
  CellLight light = solve();
  const double times = has_enough() ? 1 : rays_for_points(direct, pilot, lit, light);
  if (times >= enough_times_more) {
    if (!refine(times) || !add_direct(direct, lit)) return nullptr;
    light = solve();
  }
  std::vector<NoiseDraws> noise;
  if (options_.points.most_rays > 0)
    noise = rows_.noise_draws(rows_.differences(light.irradiance, options_.threads),
                              lit.half_difference, options_.seed, options_.threads);
  statistics_.unresolved = plan_.unresolved();
  statistics_.cells = map_->size();
  double sum = 0;
  for (size_t c = 0; c < plan_.asked().size(); ++c)
    sum += double(plan_.asked()[c]) * double(luminance(light.irradiance[c]));
  statistics_.typical = sum / pi / double(std::max<size_t>(asking_.askers, 1));
  statistics_.entries = rows_.entry_count();
  statistics_.rays = rows_.ray_count();
  statistics_.iterations = light.iterations;
  statistics_.size = double(map_->size_of_cells());
  statistics_.bytes = double(map_->bytes()) + double(rows_.entry_count()) * sizeof(RowEntry) +
                      double(noise.size() * sizeof(NoiseDraws));
  if (is_left_out<"lit regions">()) asking_.seen.clear();
  LitRegions bright(scene_.tracer, std::move(asking_.seen), light.irradiance,
                    map_->size_of_cells());
  keep(lit);
  statistics_.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return std::make_unique<Cells>(scene_, std::move(map_), std::move(lit.irradiance),
                                 std::move(light.irradiance), std::move(light.half_difference),
                                 std::move(noise), statistics_, direct.images(), std::move(bright));
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
  return builder.finish(direct, pilot, start);
}

}  // namespace troffer
