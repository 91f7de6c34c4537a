#include "integrate/cells.h"

namespace troffer {

namespace {

// Of rays that find no cell, or one that is too near, one after the other.
constexpr int most_bounces = 16;
// … or are shorter than a cell is wide.
constexpr int short_bounces = 4;

}  // namespace

bool Cells::indirect_at(const CellHit& hit, float distance, Rgb& irradiance,
                        float& half_difference) const {
  if (distance < map_->near()) return false;
  const uint32_t cell = map_->find(hit, distance);
  if (cell == no_cell) return false;
  irradiance = irradiance_[cell] - direct_[cell];
  half_difference = half_difference_[cell];
  return true;
}

CellLightAt Cells::light_at(const CellHit& hit) const {
  const uint32_t cell = map_->find(hit, map_->near());
  if (cell == no_cell) return {};
  return {direct_[cell], irradiance_[cell] - direct_[cell]};
}

// What one arrival sees: the cell's irradiance, or its direct part where what is behind it is
// looked at more closely; false where there is no cell.
bool Cells::look_up(const GatherArrival& a, bool is_last, CellsScratch& s) const {
  const uint32_t cell = map_->find(a.hit, a.distance);
  if (cell == no_cell) return false;
  const uint32_t ray = a.walk.index;
  if (a.distance < map_->near() && !is_last) {
    s.light.irradiance[ray] += a.walk.throughput * direct_[cell];
    s.again.push_back(a);
    return true;
  }
  s.light.irradiance[ray] += a.walk.throughput * irradiance_[cell];
  s.light.half_difference[ray] += luminance(a.walk.throughput) * half_difference_[cell];
  return true;
}

void Cells::gather(size_t rays, CellsScratch& s, Counters& counters) const {
  s.light.irradiance.assign(rays, Rgb{0});
  s.light.half_difference.assign(rays, 0);
  s.light.distance.assign(rays, 0);
  for (int bounce = 0; bounce < most_bounces && !s.gather.walks.empty(); ++bounce) {
    walks_.follow(rays, Coherence::none, s.gather, counters);
    if (bounce == 0) s.light.distance.swap(s.gather.black);
    s.arrivals.swap(s.gather.arrivals);
    s.again.clear();
    size_t missed = 0;
    for (GatherArrival& a : s.arrivals) {
      float& distance = s.light.distance[a.walk.index];
      if (bounce == 0 && (distance == 0 || a.length < distance)) distance = a.length;
      // The mean of a cell wider than the ray is long is not what the ray sees.
      const bool is_short = a.distance < 0.25f * map_->near() && bounce < short_bounces;
      if (is_short || !look_up(a, bounce > 0, s)) s.arrivals[missed++] = a;
    }
    s.arrivals.resize(missed);
    if (missed > 0) walks_.light_up(s.arrivals, s.gather, counters);
    for (size_t i = 0; i < rays; ++i)
      s.light.irradiance[i] += (s.gather.light.direct[i] + s.gather.light.indirect[i]) * pi_f;
    s.again.insert(s.again.end(), s.arrivals.begin(), s.arrivals.end());
    walks_.bounce(s.again, s.gather);
  }
}

}  // namespace troffer
