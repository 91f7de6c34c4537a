#include "render/refinement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace troffer {

namespace {

constexpr std::array<std::pair<int, int>, 4> neighbours{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};

bool is_inside(const PixelRect& w, int x, int y) {
  return x >= w.x0 && y >= w.y0 && x < w.x1 && y < w.y1;
}

}  // namespace

void PixelRecords::note(int x, int y, ShadowRecord&& record, bool is_first) {
  const size_t i = index(x, y);
  if (!is_first && !is_same_surface(records[i], record)) has_edge[i] = 1;
  records[i] = std::move(record);
}

NeighbourRecords PixelRecords::around(int x, int y) const {
  NeighbourRecords r{};
  r[0] = &records[index(x, y)];
  for (size_t k = 0; k < neighbours.size(); ++k) {
    const int nx = x + neighbours[k].first, ny = y + neighbours[k].second;
    if (is_inside(window, nx, ny)) r[k + 1] = &records[index(nx, ny)];
  }
  return r;
}

bool needs_refinement(const Film& film, const PixelRecords& records, int x, int y, double mean,
                      const RefinementOptions& options) {
  if (records.has_edge[records.index(x, y)] != 0) return true;
  const ShadowRecord& here = records.records[records.index(x, y)];
  const double l = film.estimate(x, y).luminance;
  for (const auto& [dx, dy] : neighbours) {
    if (!is_inside(records.window, x + dx, y + dy)) continue;
    const ShadowRecord& there = records.records[records.index(x + dx, y + dy)];
    if (!is_same_surface(here, there)) return true;
    const double other = film.estimate(x + dx, y + dy).luminance;
    if (std::abs(l - other) > double(options.contrast) * std::max(l + other, mean)) return true;
    if (double(pattern_contrast(here, there)) >
        double(options.pattern_contrast) * std::max({l, other, mean}))
      return true;
  }
  return false;
}

bool needs_more(const PixelEstimate& pixel, double mean, const RefinementOptions& options) {
  return pixel.standard_error > double(options.error) * std::max(pixel.luminance, mean);
}

}  // namespace troffer
