#include "annual/ray_log.h"

#include <algorithm>
#include <numeric>

namespace troffer {

void RayLog::add(const GatherWalks& walks, std::span<const CellTask> tasks,
                 std::span<const float> scales, size_t first_row) {
  if (regions_.size() == 0) return;
  std::vector<uint32_t> met, all(regions_.size());
  std::iota(all.begin(), all.end(), 0u);
  for (size_t t = 0; t < tasks.size(); ++t) {
    const CellTask& task = tasks[t];
    if (task.from.empty()) continue;
    const size_t first = rays_.size();
    float shares = 0;
    for (uint32_t k = 0; k < task.count; ++k) {
      Walk walk;
      walk.stream = task.stream;
      walk.sample = task.first + k;
      const CellHit& from = task.from[walk.sample % task.from.size()];
      const float share = walks.leave(from, direction_number(walk), walk);
      shares += share;
      if (walk.throughput.is_black()) continue;
      met.clear();
      if (!takes_all_) regions_.find(walk.ray, met);
      for (const uint32_t r : takes_all_ ? all : met)
        of_region_[r].push_back(uint32_t(rays_.size()));
      if (takes_all_ || !met.empty())
        rays_.push_back({uint32_t(first_row + t), walk.sample, task.stream, share, from});
    }
    // The rays of a task share the normalisation of their coats (gather/cell_rays.cpp).
    const float scale = scales.empty() ? 1.0f : scales[t];
    for (size_t i = first; i < rays_.size(); ++i) rays_[i].weight *= scale / shares;
  }
}

CellTask RayLog::task_of(uint32_t ray) const {
  const LoggedRay& r = rays_[ray];
  CellTask t;
  t.first = r.sample;
  t.count = 1;
  t.stream = r.stream;
  t.from = std::span(&r.from, 1);
  return t;
}

std::vector<CellTask> RayLog::tasks() const {
  std::vector<CellTask> out;
  for (uint32_t i = 0; i < rays_.size(); ++i) out.push_back(task_of(i));
  return out;
}

std::vector<CellTask> RayLog::tasks(size_t region) const {
  std::vector<CellTask> out;
  for (const uint32_t i : of_region_[region]) out.push_back(task_of(i));
  return out;
}

bool RayLog::is_same(uint32_t ray, std::span<const CellLink> cells,
                     std::span<const OutsideLink> outside) const {
  const auto are_equal_cells = [](const CellLink& a, const CellLink& b) {
    return a.cell == b.cell && a.weight == b.weight;
  };
  const auto are_equal_ways = [](const OutsideLink& a, const OutsideLink& b) {
    return a.direction == b.direction && a.weight == b.weight;
  };
  const std::span<const CellLink> own = seen_.cells.of(ray);
  const std::span<const OutsideLink> ways = seen_.outside.of(ray);
  return std::equal(own.begin(), own.end(), cells.begin(), cells.end(), are_equal_cells) &&
         std::equal(ways.begin(), ways.end(), outside.begin(), outside.end(), are_equal_ways);
}

SightRows RayLog::differences(size_t region, const SightRows& seen, size_t rows) const {
  SightRows out;
  std::vector<CellLink> links;
  std::vector<OutsideLink> ways;
  const std::vector<uint32_t>& rays = of_region_[region];
  size_t at = 0;
  for (size_t row = 0; row < rows; ++row) {
    links.clear();
    ways.clear();
    for (; at < rays.size() && rays_[rays[at]].row == row; ++at) {
      const uint32_t ray = rays[at];
      if (is_same(ray, seen.cells.of(at), seen.outside.of(at))) continue;
      const float w = rays_[ray].weight;
      for (const CellLink& l : seen_.cells.of(ray)) links.push_back({l.cell, l.weight * -w});
      for (const CellLink& l : seen.cells.of(at)) links.push_back({l.cell, l.weight * w});
      for (const OutsideLink& l : seen_.outside.of(ray))
        ways.push_back({l.direction, l.weight * -w});
      for (const OutsideLink& l : seen.outside.of(at)) ways.push_back({l.direction, l.weight * w});
    }
    merge_links(links);
    out.cells.add(links);
    out.outside.add(ways);
  }
  return out;
}

}  // namespace troffer
