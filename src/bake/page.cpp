#include "bake/page.h"

#include <algorithm>

namespace troffer {

namespace {

// Limit on filling from the border of a hole. Nobody sees the middle of a larger one: the body that
// covers it hides it.
constexpr int most_rounds = 64;

}  // namespace

Page::Page(int size) : size_(size) {
  const size_t all = size_t(size) * size_t(size);
  texels_.resize(all);
  chart_.assign(all, no_chart);
  is_known_.assign(all, 0);
}

void Page::set(int x, int y, uint32_t chart, const PageTexel& texel, bool is_known) {
  if (x < 0 || y < 0 || x >= size_ || y >= size_) return;
  const size_t i = index(x, y);
  chart_[i] = chart;
  is_known_[i] = is_known;
  if (is_known) texels_[i] = texel;
}

// Averages neighbours of the texel's chart; without a chart, those of the first neighbour's chart.
bool Page::mean_of_neighbours(size_t texel, PageTexel& out, uint32_t& chart) const {
  const int x = int(texel % size_t(size_)), y = int(texel / size_t(size_));
  chart = chart_[texel];
  out = {Rgb{0}, 0, 0};
  float weights = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const int nx = x + dx, ny = y + dy;
      if (nx < 0 || ny < 0 || nx >= size_ || ny >= size_) continue;
      const size_t n = index(nx, ny);
      if (!is_known_[n] || (chart != no_chart && chart_[n] != chart)) continue;
      chart = chart_[n];
      const float weight = dx == 0 || dy == 0 ? 2 : 1;
      out.color += texels_[n].color * weight;
      out.alpha += texels_[n].alpha * weight;
      out.error += texels_[n].error * weight;
      weights += weight;
    }
  }
  if (weights == 0) return false;
  out.color = out.color / weights;
  out.alpha /= weights;
  out.error /= weights;
  return true;
}

// Fills texels from the values before the round; texels without valued neighbours stay open.
void Page::fill_round(std::vector<size_t>& open) {
  struct Found {
    size_t texel;
    uint32_t chart;
    PageTexel value;
  };
  std::vector<Found> found;
  size_t left = 0;
  for (const size_t i : open) {
    Found f{i, no_chart, {}};
    if (mean_of_neighbours(i, f.value, f.chart))
      found.push_back(f);
    else
      open[left++] = i;
  }
  open.resize(left);
  for (const Found& f : found) {
    texels_[f.texel] = f.value;
    chart_[f.texel] = f.chart;
    is_known_[f.texel] = 1;
  }
}

// Returns the texels of no chart next to these.
std::vector<size_t> Page::around(const std::vector<size_t>& texels) const {
  std::vector<size_t> out;
  for (const size_t i : texels) {
    const int x = int(i % size_t(size_)), y = int(i / size_t(size_));
    for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, size_ - 1); ++ny)
      for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, size_ - 1); ++nx)
        if (chart_[index(nx, ny)] == no_chart) out.push_back(index(nx, ny));
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

void Page::fill(int gutter) {
  std::vector<size_t> holes, ring;
  for (size_t i = 0; i < chart_.size(); ++i) {
    if (chart_[i] == no_chart) continue;
    ring.push_back(i);
    if (!is_known_[i]) holes.push_back(i);
  }
  for (int round = 0; round < most_rounds && !holes.empty(); ++round) {
    const size_t before = holes.size();
    fill_round(holes);
    if (holes.size() == before) break;
  }
  for (int round = 0; round < gutter; ++round) {
    ring = around(ring);
    std::vector<size_t> open = ring;
    fill_round(open);
  }
}

}  // namespace troffer
