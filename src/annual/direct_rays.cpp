#include "annual/direct_rays.h"

#include <algorithm>

#include "base/random.h"
#include "base/streams.h"

namespace troffer {

namespace {

static_assert(sun_strata == size_t(replicate_count));

// Rays to the rim of the sun disagree if one brings less than this share of another one. Panes
// alone make less of a difference across half a degree, but at grazing angles.
constexpr float like_others = 0.95f;

}  // namespace

DirectRays::DirectRays(const YearOutside& outside, const StateFamily& family, size_t sensor,
                       Parts parts)
    : outside_(outside),
      family_(family),
      sensor_(sensor),
      place_(family.sensors[sensor]),
      side_(outside.skies.fine.sky.strata_per_side()),
      of_region_(family.regions.size()) {
  if (parts == Parts::all) add_sky();
  first_of_ground_ = rays_.size();
  if (parts == Parts::all) add_ground();
  first_of_sun_ = rays_.size();
  add_sun();
  trace();
}

void DirectRays::add_sky() {
  Random random(hash_of(outside_.seed, uint64_t(sensor_), stream::annual_direct_sky));
  for (const ReinhartPatch& p : outside_.skies.fine.sky.patches())
    for (size_t i = 0; i < strata(); ++i)
      for (size_t r = 0; r < replicate_count; ++r) {
        const double u = (double(i % side_) + random.next_double()) / double(side_);
        const double v = (double(i / side_) + random.next_double()) / double(side_);
        const Vec3 d = outside_.world(p.direction(u, v));
        add(d, dot(d, place_.normal));
      }
}

// The ground has uniform luminance: the mirrored coarse patches only stratify it.
void DirectRays::add_ground() {
  Random random(hash_of(outside_.seed, uint64_t(sensor_), stream::annual_direct_ground));
  for (const ReinhartPatch& p : outside_.skies.coarse.sky.patches())
    for (size_t r = 0; r < replicate_count; ++r) {
      const double u = random.next_double();
      Vec3d d = p.direction(u, random.next_double());
      d.z = -d.z;
      add(outside_.world(d), dot(outside_.world(d), place_.normal));
    }
}

Vec3 DirectRays::to_sun(uint32_t hour) const {
  return outside_.world(direction_of(outside_.year.steps[outside_.skies.steps[hour]].sun));
}

// Rays to points of the sun's disc, then to its rim. All of an hour have the cosine of its middle.
// Each replicate has another stratum of the disc. Its strata of different hours are independent.
void DirectRays::add_sun() {
  Random random(hash_of(outside_.seed, uint64_t(sensor_), stream::annual_direct_sun));
  const YearSkies& skies = outside_.skies;
  for (uint32_t h = 0; h < skies.hours(); ++h) {
    if (skies.sun_lx[h] == 0) continue;
    const Vec3 sun = to_sun(h);
    const float cosine = dot(sun, place_.normal);
    if (cosine <= 0) continue;
    sun_hours_.push_back(h);
    for (const Vec3& d : over_sun(sun, random)) add(d, cosine);
    for (const Vec3& d : rim_of_sun(sun, random)) add(d, cosine);
  }
}

void DirectRays::trace() {
  open_.assign(rays_.size(), 0);
  OpenRays rays(family_.states[0].scene->tracer);
  std::vector<uint32_t> sent, met;
  const auto receive = [&] {
    rays.trace();
    for (size_t k = 0; k < sent.size(); ++k) open_[sent[k]] = luminance(rays[k]);
    rays.clear();
    sent.clear();
  };
  for (uint32_t i = 0; i < rays_.size(); ++i) {
    if (!(rays_[i].cosine > 0)) continue;
    const Ray& ray = rays.add(place_, rays_[i].direction);
    met.clear();
    family_.regions.find(ray, met);
    for (const uint32_t r : met) of_region_[r].push_back(i);
    sent.push_back(i);
    if (sent.size() >= OpenRays::enough) receive();
  }
  receive();
}

std::vector<float> DirectRays::open_in(const StateOfFamily& state,
                                       std::span<const float> fixed) const {
  std::vector<float> open = open_;
  if (&state != &family_.states[0]) {
    const std::vector<uint32_t>& crossing = of_region_[state.region];
    OpenRays rays(state.scene->tracer);
    for (const uint32_t i : crossing) rays.add(place_, rays_[i].direction);
    rays.trace();
    for (size_t k = 0; k < crossing.size(); ++k) open[crossing[k]] = luminance(rays[k]);
  }
  find_sun(state.scene->tracer, open);
  for (size_t i = 0; i < fixed.size(); ++i) open[i] -= fixed[i];
  return open;
}

// Replaces the values of rays to the sun by one of each hour and replicate. Rays to the rim decide
// whether a replicate gets more rays to the disc, which then replace its only one. As they decide
// nothing else, its value is unbiased.
void DirectRays::find_sun(const Tracer& tracer, std::vector<float>& open) const {
  OpenRays rays(tracer);
  for (size_t i = 0; i < sun_hours_.size(); ++i) {
    const float* of_hour = open.data() + first_of_sun_ + i * rays_of_sun;
    float* out = open.data() + first_of_sun_ + i * sun_strata;
    const auto [least, most] = std::minmax_element(of_hour + sun_strata, of_hour + rays_of_sun);
    const bool has_edge = *least < like_others * *most;
    std::copy_n(of_hour, sun_strata, out);
    if (!has_edge) continue;
    const Vec3 sun = to_sun(sun_hours_[i]);
    Random random(hash_of(outside_.seed, uint64_t(sensor_), uint64_t(sun_hours_[i]),
                          stream::annual_direct_sun));
    rays.clear();
    for (size_t r = 0; r < size_t(replicate_count); ++r)
      for (const Vec3& d : over_sun(sun, random)) rays.add(place_, d);
    rays.trace();
    for (size_t r = 0; r < size_t(replicate_count); ++r) {
      float sum = 0;
      for (size_t k = 0; k < sun_strata; ++k) sum += luminance(rays[r * sun_strata + k]);
      out[r] = sum / float(sun_strata);
    }
  }
  open.resize(first_of_sun_ + sun_hours_.size() * sun_strata);
}

std::vector<SunHour> DirectRays::sun_in(const StateOfFamily& state,
                                        std::span<const float> fixed) const {
  const std::vector<float> open = open_in(state, fixed);
  std::vector<SunHour> hours;
  for (size_t i = 0; i < sun_hours_.size(); ++i) {
    const float lx = outside_.skies.sun_lx[sun_hours_[i]] * sun_cosine(i);
    float sum = 0;
    for (size_t r = 0; r < replicate_count; ++r)
      sum += lx * open[first_of_sun_ + i * replicate_count + r];
    if (sum != 0) hours.push_back({sun_hours_[i], sum / float(replicate_count)});
  }
  return hours;
}

}  // namespace troffer
