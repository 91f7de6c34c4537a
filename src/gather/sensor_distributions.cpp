#include "gather/sensor_distributions.h"

namespace troffer {

namespace {

constexpr size_t rays_for_sight = 4;  // gather rays per visibility test

}  // namespace

CellHit hit_of(const SensorBatch& sensors, size_t i) {
  return {sensors.positions[i], sensors.normals[i], sensors.normals[i], sensors.offset};
}

void SensorDistributions::begin(const LitRegions& places, const SensorBatch& sensors) {
  places_ = &places;
  sensors_ = &sensors;
  end_ = 0;
  has_sight_ = false;
}

const GatherDistribution& SensorDistributions::at(size_t i) {
  if (i < end_) return aim_;
  const SensorBatch& s = *sensors_;
  bool is_place = true;
  Vec3 position, normal;
  size_t n = 0;
  for (end_ = i; end_ < s.size() && s.streams[end_] == s.streams[i]; ++end_, ++n) {
    is_place &= s.positions[end_] == s.positions[i] && s.normals[end_] == s.normals[i];
    position += s.positions[end_];
    normal += s.normals[end_];
  }
  CellHit at = hit_of(s, i);
  if (is_place) {
    if (is_for_place_ && at.position == place_.position && at.normal == place_.normal) return aim_;
    aim_ = GatherDistribution(*places_, places_->visibility_from({&at, 1}), at);
    place_ = at;
  } else {
    look_from_patches();
    at.position = position * (1 / float(n));
    if (length(normal) > 0) at.normal = at.horizon = normalize(normal);
    aim_ = GatherDistribution(*places_, sight_, at);
  }
  is_for_place_ = is_place;
  return aim_;
}

void SensorDistributions::look_from_patches() {
  if (has_sight_ || places_->all().empty()) return;
  std::vector<CellHit> from;
  for (size_t i = 0; i < sensors_->size(); ++i) from.push_back(hit_of(*sensors_, i));
  sight_ = places_->visibility_from(from, from.size() / rays_for_sight);
  has_sight_ = true;
}

}  // namespace troffer
