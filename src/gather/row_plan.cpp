#include "gather/row_plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/ablation.h"
#include "base/random.h"
#include "base/streams.h"

namespace troffer {

namespace {

// All measured: docs/log/cells.md.
constexpr uint32_t rays_of_step = 8;  // further rays come in steps of this many
// Importance that is worth a first ray of a cell, in mean pilot gather rays with all bounces
// counted, at `fine_error`. It goes with this power of the error.
constexpr double pilots_of_ray = 0.1, worth_by_error = 1.5;
constexpr double most_coarseness = 4;
constexpr uint32_t most_rays_of_row = 4096;  // further rays of a row
constexpr double most_unresolved = 1e-5;  // share of the asked light, for an error of .01 or less
constexpr uint32_t rays_of_refining_task = 16;
constexpr double most_refined = 1 << 18;  // rays of a row
constexpr double enough_of_wanted =
    1.5;  // cells that want fewer than this times their rays get none
// Bounces over which importance is propagated: to share out further rays and to check that rows are
// complete, and at each look for cells without a row. What one look leaves, the next one takes up.
constexpr int bounces_of_importance = 24, bounces_of_look = 6;

}  // namespace

double coarseness(double error, double fine) {
  if (is_left_out<"coarser cells">()) return 1;
  return std::clamp(error / fine, 1.0, most_coarseness);
}

void RowPlan::ask(uint32_t cell, float light) {
  if (cell >= asked_.size()) asked_.resize(cell + 1, 0);
  asked_[cell] += light;
}

void RowPlan::end_asking() {
  const double all = std::accumulate(asked_.begin(), asked_.end(), 0.0);
  const double error = std::clamp(error_, 1e-3, 0.2) / fine_error;
  of_ray_ = pilots_of_ray * std::pow(error, worth_by_error) * all / double(pilot_rays);
}

void RowPlan::look(int bounces) {
  importance_ = rows_.importance(asked_, std::move(importance_), bounces);
}

CellTask RowPlan::task_of(uint32_t cell, uint32_t first, uint32_t count) const {
  return {cell,
          first,
          count,
          hash_of(seed_, cell, stream::cell_rows),
          1,
          {},
          first / rays_of_step % 2 == 1};
}

// Returns the cells without a row, the most important first, except for those that hardly matter.
std::vector<uint32_t> RowPlan::cells_to_resolve(int bounces) {
  look(bounces);
  const std::vector<float>& y = importance_;
  double all = 0, open = 0;
  std::vector<uint32_t> cells;
  for (uint32_t c = 0; c < y.size(); ++c) {
    all += double(y[c]);
    if (rows_.has_row(c)) continue;
    open += double(y[c]);
    cells.push_back(c);
  }
  unresolved_ = all > 0 ? open / all : 0;
  const double most = most_unresolved * coarseness(error_, 0.01);
  if (unresolved_ <= most || asked_.size() > most_cells) return {};
  std::sort(cells.begin(), cells.end(),
            [&](uint32_t a, uint32_t b) { return y[a] != y[b] ? y[a] > y[b] : a < b; });
  double left = open;
  size_t kept = 0;
  while (kept < cells.size() && left > 0.5 * most * all) left -= double(y[cells[kept++]]);
  cells.resize(kept);
  return cells;
}

// The cell's importance decides. In the open and between small things, few rays share cells. 16
// rays from each cell there, and from all cells that they hit, would grow into an endless tree.
// With one ray each, the tree is a path.
uint32_t RowPlan::first_rays(uint32_t cell) const {
  if (is_left_out<"fewer first cell rays">()) return rays_of_row;
  if (cell >= importance_.size()) return 1;
  const double worth = double(importance_[cell]) / of_ray_;
  uint32_t n = rays_of_row;
  while (n > 1 && worth < n) n /= 2;
  return n;
}

// Adds the first `count` rays of a cell, except for the first `had`. Each half of them comes from
// its own half of the sequence.
void RowPlan::add_first_tasks(uint32_t cell, uint32_t had, uint32_t count,
                              std::vector<CellTask>& tasks) const {
  const auto add = [&](uint32_t first, uint32_t end, uint32_t begin) {
    if (end > first) tasks.push_back(task_of(cell, begin + first, end - first));
  };
  add((had + 1) / 2, (count + 1) / 2, 0);
  add(had / 2, count / 2, rays_of_step);
}

// Cells that turn out to matter get more rays. Otherwise a cell whose few rays met only itself, for
// example, would keep its light for ever.
std::vector<CellTask> RowPlan::first_tasks() {
  std::vector<CellTask> tasks;
  std::vector<uint32_t> cells = cells_to_resolve(bounces_of_look);
  if (cells.empty()) cells = cells_to_resolve(bounces_of_importance);
  for (const uint32_t c : cells) add_first_tasks(c, 0, first_rays(c), tasks);
  for (uint32_t c = 0; !tasks.empty() && c < importance_.size(); ++c)
    if (rows_.has_row(c) && first_rays(c) >= 2 * rows_.rays(c))
      add_first_tasks(c, rows_.rays(c), first_rays(c), tasks);
  return tasks;
}

double RowPlan::rays_that_matter(size_t frozen) const {
  const double all = std::accumulate(importance_.begin(), importance_.end(), 0.0);
  const double least = frozen > 0 ? 0.5 * most_unresolved * all / double(importance_.size()) : -1;
  double rays = 0;
  for (uint32_t c = 0; c < importance_.size(); ++c)
    if (rows_.has_row(c) && double(importance_[c]) > least)
      rays += std::min(rows_.rays(c), rays_of_row);
  return rays;
}

std::vector<CellTask> RowPlan::further_tasks(size_t frozen) {
  look(bounces_of_importance);
  const std::vector<float>& y = importance_;
  const double all = std::accumulate(y.begin(), y.end(), 0.0);
  std::vector<CellTask> tasks;
  if (!(all > 0)) return tasks;
  const double steps = rays_that_matter(frozen) / rays_of_step;
  const double most = double(most_rays_of_row) / rays_of_step;
  for (uint32_t c = 0; c < y.size(); ++c) {
    if (!rows_.has_row(c)) continue;
    const double wanted = std::min(steps * double(y[c]) / all, most);
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

std::vector<CellTask> RowPlan::refining_tasks(double rays) {
  look(bounces_of_importance);
  const std::vector<float>& y = importance_;
  const double all = std::accumulate(y.begin(), y.end(), 0.0);
  std::vector<CellTask> tasks;
  for (uint32_t c = 0; all > 0 && c < y.size(); ++c) {
    if (!rows_.has_row(c)) continue;
    const double wanted = std::min(rays * double(y[c]) / all, most_refined);
    if (wanted < enough_of_wanted * rows_.rays(c)) continue;
    const auto half = uint32_t((wanted - rows_.rays(c)) / 2 + 0.5);
    for (const bool is_second : {false, true})
      for (uint32_t first = 0; first < half; first += rays_of_refining_task)
        tasks.push_back({c,
                         first,
                         std::min(half - first, rays_of_refining_task),
                         hash_of(seed_, c, is_second ? 1u : 0u, stream::cell_row_refinement),
                         1,
                         {},
                         is_second});
  }
  return tasks;
}

}  // namespace troffer
