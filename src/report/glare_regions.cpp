#include "report/glare_regions.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "base/units.h"

namespace troffer {

namespace {

// Sets of pixels, joined step by step. The smallest member names its set.
class PixelSets {
 public:
  explicit PixelSets(size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  size_t find(size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(size_t a, size_t b) {
    const size_t i = find(a), k = find(b);
    parent_[std::max(i, k)] = std::min(i, k);
  }

 private:
  std::vector<size_t> parent_;
};

class Regions {
 public:
  Regions(const FisheyeGrid& grid, double link_rad)
      : grid_(grid), least_cosine_(std::cos(link_rad)), link_rad_(link_rad) {}

  // Joins the chosen pixels. group: pixels of different groups stay apart.
  std::vector<GlareRegion> joined(const std::vector<uint8_t>& chosen,
                                  const std::vector<uint32_t>& group) const;

 private:
  const FisheyeGrid& grid_;
  double least_cosine_, link_rad_;

  bool is_inner(const std::vector<uint8_t>& chosen, const std::vector<uint32_t>& group, int x,
                int y) const;
};

// True if a pixel's neighbours are all chosen: the rim of its region is then nearer to any other.
bool Regions::is_inner(const std::vector<uint8_t>& chosen, const std::vector<uint32_t>& group,
                       int x, int y) const {
  const int n = grid_.side;
  if (x == 0 || y == 0 || x + 1 == n || y + 1 == n) return false;
  const auto at = [n](int i, int j) { return size_t(j) * size_t(n) + size_t(i); };
  const size_t own = at(x, y);
  for (const size_t k : {at(x - 1, y), at(x + 1, y), at(x, y - 1), at(x, y + 1)})
    if (!chosen[k] || group[k] != group[own]) return false;
  return true;
}

std::vector<GlareRegion> Regions::joined(const std::vector<uint8_t>& chosen,
                                         const std::vector<uint32_t>& group) const {
  const int n = grid_.side;
  PixelSets sets(chosen.size());
  // A pixel is pi / side high along a radius, and at most pi / 2 times narrower across it.
  const int reach = int(std::ceil(link_rad_ * double(n) / pi * (pi / 2))) + 1;
  std::vector<Vec3d> directions(chosen.size());
  std::vector<int> rim;
  for (size_t k = 0; k < chosen.size(); ++k) {
    if (!chosen[k]) continue;
    const int x = int(k) % n, y = int(k) / n;
    directions[k] = grid_.direction(x, y);
    if (x + 1 < n && chosen[k + 1] && group[k + 1] == group[k]) sets.join(k, k + 1);
    if (y + 1 < n && chosen[k + size_t(n)] && group[k + size_t(n)] == group[k])
      sets.join(k, k + size_t(n));
    if (!is_inner(chosen, group, x, y)) rim.push_back(int(k));
  }
  std::vector<uint8_t> is_rim(chosen.size());
  for (const int k : rim) is_rim[size_t(k)] = 1;
  for (const int k : rim) {
    const int x = k % n, y = k / n;
    for (int j = y; j <= std::min(y + reach, n - 1); ++j)
      for (int i = std::max(x - reach, 0); i <= std::min(x + reach, n - 1); ++i) {
        const size_t other = size_t(j) * size_t(n) + size_t(i), own = size_t(k);
        if (!is_rim[other] || group[other] != group[own] || sets.find(other) == sets.find(own))
          continue;
        if (dot(directions[own], directions[other]) >= least_cosine_) sets.join(own, other);
      }
  }
  std::map<size_t, GlareRegion> regions;
  for (size_t k = 0; k < chosen.size(); ++k)
    if (chosen[k]) regions[sets.find(k)].push_back(k);
  std::vector<GlareRegion> out;
  for (auto& [first, region] : regions) out.push_back(std::move(region));
  return out;
}

}  // namespace

Vec3d FisheyeGrid::direction(double x, double y) const {
  const double scale = pi / double(side);
  const double a = (x + 0.5 - double(side) / 2) * scale, b = (double(side) / 2 - y - 0.5) * scale;
  const double r = std::hypot(a, b);
  const double across = r > 0 ? std::sin(r) / r : 1;
  return {a * across, b * across, std::cos(r)};
}

double FisheyeGrid::solid_angle(int x, int y) const {
  const double scale = pi / double(side);
  const double r =
      std::hypot(double(x) + 0.5 - double(side) / 2, double(side) / 2 - double(y) - 0.5) * scale;
  if (r > pi / 2) return 0;
  return (r > 0 ? std::sin(r) / r : 1) * scale * scale;
}

std::vector<GlareRegion> glare_regions(const FisheyeGrid& grid, const Image& picture,
                                       double threshold, double peak, double link_rad) {
  const auto n = size_t(grid.side);
  const Regions regions(grid, link_rad);
  std::vector<uint8_t> bright(n * n), peaks(n * n);
  std::vector<uint32_t> group(n * n);
  for (size_t k = 0; k < n * n; ++k)
    bright[k] =
        double(picture.pixels[k].r) > threshold && grid.solid_angle(int(k % n), int(k / n)) > 0;
  std::vector<GlareRegion> out, whole = regions.joined(bright, group);
  for (size_t r = 0; r < whole.size(); ++r) {
    GlareRegion rest;
    for (const size_t k : whole[r]) {
      group[k] = uint32_t(r);
      peaks[k] = peak > 0 && double(picture.pixels[k].r) >= peak;
      if (!peaks[k]) rest.push_back(k);
    }
    if (!rest.empty()) out.push_back(std::move(rest));
  }
  for (GlareRegion& region : regions.joined(peaks, group)) out.push_back(std::move(region));
  return out;
}

}  // namespace troffer
