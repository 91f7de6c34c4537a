#include "annual/reflected_store.h"

#include <cstring>
#include <span>

#include "base/error.h"
#include "base/hasher.h"
#include "base/own_file.h"

namespace troffer {

namespace {

// Start of an item. The coefficients follow.
struct ItemHeader {
  uint64_t state, replicate, sources, cells, links, sensors;
};

PictureKey key_of_scene(const std::string& program, const Scene& scene) {
  return picture_key(program, scene, {}, {}, {});
}

}  // namespace

PictureKey reflected_key(const std::string& program, const std::vector<LightPath>& paths,
                         const std::vector<MeasuringPoint>& points, const WeatherYear& year,
                         const Compass& compass, const ReflectedOptions& options) {
  Hasher scenes(1), settings(2);
  PictureKey key;
  for (const LightPath& p : paths)
    for (const PathState& s : p.states) {
      key = key_of_scene(program, s.scene->scene);
      scenes.add(key.scene);
    }
  settings.add_all(points.size(), year.latitude_deg, year.longitude_deg, year.zone_hours,
                   year.steps.size(), options.rays.of_sensor, options.seed);
  for (const MeasuringPoint& p : points)
    settings.add_all(p.position.x, p.position.y, p.position.z, p.normal);
  for (const WeatherStep& s : year.steps)
    settings.add_all(s.hour_of_year, s.direct_normal, s.diffuse_horizontal, s.sun.azimuth_deg,
                     s.sun.altitude_deg);
  for (const Vec3d& d : {compass.east, compass.north, compass.up}) settings.add_all(d.x, d.y, d.z);
  key.scene = scenes.value();
  key.settings = settings.value();
  return key;
}

void ReflectedStore::save_to(const std::string& file, const PictureKey& key, double interval,
                             Checkpoint::Warn warn) {
  checkpoint_ = std::make_unique<Checkpoint>(file, key, PictureShare{}, interval, std::move(warn));
}

void ReflectedStore::read(const std::string& file, const PictureKey& key) {
  Checkpoint from(file, key, {}, 0, {});
  from.read();
  for (const std::span<const uint8_t> chunk : from.chunks()) {
    if (chunk.size() < sizeof(ItemHeader)) from.refuse_chunks();
    const auto h = ByteReader(chunk).next<ItemHeader>();
    items_[{h.state, h.replicate}] = {{chunk.begin(), chunk.end()}, file};
  }
}

bool ReflectedStore::find(size_t state, size_t replicate, size_t sensors, ReflectedReplicate& out) {
  const auto at = items_.find({state, replicate});
  if (at == items_.end()) return false;
  const std::span<const uint8_t> bytes = at->second.bytes;
  const auto h = ByteReader(bytes).next<ItemHeader>();
  const size_t floats = (bytes.size() - sizeof(ItemHeader)) / sizeof(float);
  const bool fits = h.sensors == sensors && h.sources == out.sources &&
                    floats == sensors * out.sources &&
                    bytes.size() == sizeof(ItemHeader) + floats * sizeof(float);
  if (!fits) throw InputError(at->second.file, 0, 0, "checkpoint has invalid values");
  out.cells = h.cells;
  out.links = h.links;
  out.coefficients.resize(floats);
  std::memcpy(out.coefficients.data(), bytes.data() + sizeof(ItemHeader), floats * sizeof(float));
  return true;
}

void ReflectedStore::keep(size_t state, size_t replicate, const ReflectedReplicate& item) {
  if (!checkpoint_) return;
  std::vector<uint8_t> bytes;
  append(bytes, ItemHeader{state, replicate, item.sources, item.cells, item.links,
                           item.sources == 0 ? 0 : item.coefficients.size() / item.sources});
  const size_t start = bytes.size();
  bytes.resize(start + item.coefficients.size() * sizeof(float));
  if (!item.coefficients.empty())
    std::memcpy(bytes.data() + start, item.coefficients.data(), bytes.size() - start);
  items_[{state, replicate}] = {std::move(bytes), {}};
  if (checkpoint_->take_turn()) write();
}

void ReflectedStore::write() {
  checkpoint_->write([&](const Checkpoint::Add& add) {
    for (const auto& [key, item] : items_) add(item.bytes);
  });
}

std::string ReflectedStore::save() {
  if (!checkpoint_) return {};
  write();
  return checkpoint_->failure();
}

}  // namespace troffer
