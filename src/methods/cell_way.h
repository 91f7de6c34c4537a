// Choice of the cheapest way to make a picture whose cells are made.
#pragma once

#include <cstdint>
#include <optional>

namespace troffer {

// gathers: certified direct light, reflected light gathered from cells. cached_paths: paths that
// end at cells. paths: plain paths, which do not use the cells.
enum class CellWay : uint8_t { gathers, cached_paths, paths };

// Returns the way of least cost, by predicted costs in rays (costs.h); no value: the way is not
// possible. The cost of plain paths is known best, so other ways have to promise clearly less.
// Cached paths have to promise clearly less than gathers, because their forecast sees few rare
// bright rays.
inline CellWay cheapest_way(std::optional<double> by_paths, std::optional<double> by_cached_paths,
                            double by_gathers) {
  constexpr double uncertainty = 1.25;  // factor of spread that bench/costs prints
  const bool is_cached = by_cached_paths && uncertainty * *by_cached_paths < by_gathers;
  const double least = is_cached ? *by_cached_paths : by_gathers;
  if (by_paths && *by_paths < uncertainty * least) return CellWay::paths;
  return is_cached ? CellWay::cached_paths : CellWay::gathers;
}

}  // namespace troffer
