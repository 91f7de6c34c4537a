#include "gather/cells.h"

#include <algorithm>
#include <cmath>

#include "base/ablation.h"
#include "base/error.h"
#include "base/random.h"
#include "base/streams.h"
#include "base/units.h"

namespace troffer {

namespace {

// Limit of successive rays that find no cell, or one that is too near.
constexpr int most_bounces = 16;
// Limit of successive rays that are shorter than a cell is wide: in pictures, and at measuring
// points. In a gap of 5 cm behind a luminaire nearly all rays are short. With fewer of them points
// there are 1 to 4 % too dark, but pictures would take longer (docs/log/cells.md).
constexpr int short_bounces = 4, most_short = 8;
// Rays that are followed together: few enough to stay in the caches.
constexpr size_t rays_of_part = 256;
// Test of resolve_narrow_where_worth_it(): places, rays per place, and the largest acceptable
// variance relative to that without looking closely.
constexpr size_t most_tried = 16;
constexpr uint32_t rays_of_try = 1024;
constexpr double most_times_usual = 3;

}  // namespace

void GatheredLight::reset(size_t rays) {
  irradiance.assign(rays, Rgb{0});
  half_difference.assign(rays, 0);
  distance.assign(rays, 0);
  noise = {};
}

bool Cells::indirect_at(const CellHit& hit, float distance, Rgb& irradiance,
                        float& half_difference) const {
  if (distance < map_->near()) return false;
  const uint32_t cell = map_->find(hit, distance);
  if (cell == no_cell) return false;
  irradiance = irradiance_[cell] - direct_[cell];
  half_difference = half_difference_[cell];
  return true;
}

bool Cells::irradiance_at(const CellHit& hit, float distance, Rgb& irradiance,
                          float& half_difference) const {
  if (distance < map_->near()) return false;
  const uint32_t cell = map_->find(hit, distance);
  if (cell == no_cell) return false;
  irradiance = irradiance_[cell];
  half_difference = half_difference_[cell];
  return true;
}

CellLightAt Cells::light_at(const CellHit& hit) const {
  const uint32_t cell = map_->find_from_afar(hit);
  if (cell == no_cell) return {};
  return {direct_[cell], irradiance_[cell] - direct_[cell]};
}

// Adds what one arrival sees. That is the cell's irradiance, or, for a short first ray, only its
// direct part: a further ray then brings the rest. False if the arrival must sample lights and go
// on: it has no cell, or its first hit is on a sub-cell feature that is to be resolved.
bool Cells::look_up(const GatherArrival& a, uint64_t voxel, int bounce, CellsScratch& s) const {
  const uint32_t cell = map_->find(a.hit, a.distance, voxel);
  if (cell == no_cell) return false;
  if (!is_left_out<"narrow cells">() && bounce == 0 && resolves_narrow_ && map_->is_narrow(cell))
    return false;
  const uint32_t ray = a.walk.index;
  if (a.distance < map_->near() && bounce == 0) {
    s.part.irradiance[ray] += a.walk.throughput * direct_[cell];
    s.again.push_back(a);
    return true;
  }
  s.part.irradiance[ray] += a.walk.throughput * irradiance_[cell];
  const float weight = luminance(a.walk.throughput);
  s.part.half_difference[ray] += weight * half_difference_[cell];
  if (!noise_.empty() && std::isfinite(weight)) add_draws(s.light.noise, weight, noise_[cell]);
  return true;
}

void Cells::gather(size_t rays, CellsScratch& s, Counters& counters) const {
  s.light.reset(rays);
  auto next = s.walks.begin();
  for (size_t first = 0; first < rays; first += rays_of_part) {
    const size_t n = std::min(rays_of_part, rays - first);
    s.gather.walks.clear();
    for (; next != s.walks.end() && next->index < first + n; ++next) {
      TROFFER_CHECK(next->index >= first);
      s.gather.walks.push_back(*next);
      s.gather.walks.back().index -= uint32_t(first);
    }
    const CheckPart part(first);
    gather_part(n, s, counters);
    const auto put = [first](const auto& from, auto& to) {
      std::copy(from.begin(), from.end(), to.begin() + std::ptrdiff_t(first));
    };
    put(s.part.irradiance, s.light.irradiance);
    put(s.part.half_difference, s.light.half_difference);
    put(s.part.distance, s.light.distance);
  }
  TROFFER_CHECK(next == s.walks.end());
}

// Follows s.gather.walks, of indices below `rays`, into s.part.
void Cells::gather_part(size_t rays, CellsScratch& s, Counters& counters) const {
  s.part.reset(rays);
  for (int bounce = 0; bounce < most_bounces && !s.gather.walks.empty(); ++bounce) {
    walks_.follow(rays, Coherence::none, s.gather, counters);
    if (bounce == 0) s.part.distance.swap(s.gather.black);
    s.arrivals.swap(s.gather.arrivals);
    s.again.clear();
    s.voxels.clear();
    for (const GatherArrival& a : s.arrivals)
      s.voxels.push_back(map_->prefetch_voxel(a.hit, a.distance));
    for (const uint64_t voxel : s.voxels) map_->prefetch_cell(voxel);
    size_t missed = 0;
    for (size_t i = 0; i < s.arrivals.size(); ++i) {
      const GatherArrival& a = s.arrivals[i];
      float& distance = s.part.distance[a.walk.index];
      if (bounce == 0 && (distance == 0 || a.length < distance)) distance = a.length;
      // A ray shorter than the cell is wide does not see the mean of the cell.
      const float short_ray = (bounce > 0 && has_noise_draws() ? 1.0f : 0.25f) * map_->near();
      const bool is_short = !is_left_out<"short rays">() && a.distance < short_ray &&
                            bounce < (has_noise_draws() ? most_short : short_bounces);
      if (is_short || !look_up(a, s.voxels[i], bounce, s)) s.arrivals[missed++] = a;
    }
    s.arrivals.resize(missed);
    if (bounce > 0) keep_one_of_each(s.arrivals);
    if (!s.arrivals.empty()) walks_.sample_direct_light(s.arrivals, s.gather, counters);
    for (size_t i = 0; i < rays; ++i)
      s.part.irradiance[i] += (s.gather.light.direct[i] + s.gather.light.indirect[i]) * pi_f;
    s.again.insert(s.again.end(), s.arrivals.begin(), s.arrivals.end());
    walks_.bounce(s.again, s.gather);
  }
}

// Variance of one gather ray over its squared mean, averaged over some of the places.
double Cells::variance_of_rays(std::span<const CellHit> places, uint64_t seed,
                               Counters& counters) const {
  CellsScratch s;
  double sum_of_variances = 0;
  const size_t tried = std::min(places.size(), most_tried);
  for (size_t p = 0; p < tried; ++p) {
    s.walks.clear();
    for (uint32_t k = 0; k < rays_of_try; ++k) {
      Walk walk;
      walk.index = k;
      walk.sample = k;
      walk.stream = hash_of(seed, p, stream::narrow_cells_test);
      set_out(places[p * places.size() / tried], direction_number(walk), walk);
      s.walks.push_back(walk);
    }
    gather(rays_of_try, s, counters);
    double sum = 0, squares = 0;
    for (const Rgb& e : s.light.irradiance) {
      sum += double(luminance(e));
      squares += sqr(double(luminance(e)));
    }
    if (sum > 0) sum_of_variances += squares * rays_of_try / sqr(sum) - 1;
  }
  return tried > 0 ? sum_of_variances / double(tried) : 0;
}

void Cells::resolve_narrow_where_worth_it(std::span<const CellHit> places, uint64_t seed,
                                          Counters& counters) {
  const double usual = variance_of_rays(places, seed, counters);
  resolves_narrow_ = true;
  if (variance_of_rays(places, seed, counters) > most_times_usual * usual) resolves_narrow_ = false;
}

}  // namespace troffer
