#include "view/dimmers.h"

#include <algorithm>
#include <cmath>

#include "render/source_info.h"
#include "scene/scaled_lights.h"

namespace troffer {

namespace {

// Limit on the triangles of all copies together.
constexpr size_t most_triangles = 8'000'000;

// Environment lights have no power of their own; they rank highest.
double rank(const Dimmer& d) {
  return d.power > 0 && std::isfinite(d.power) ? d.power : 1e300;
}

}  // namespace

std::vector<Dimmer> dimmers_of(const Scene& scene, size_t most) {
  std::vector<Dimmer> all;
  const std::vector<SourceInfo> infos = source_infos(scene);
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    const std::string& name = scene.lights[i].name;
    auto at = std::find_if(all.begin(), all.end(), [&](const Dimmer& d) { return d.name == name; });
    if (at == all.end()) at = all.insert(at, Dimmer{name, {name}, 0});
    at->power += infos[i].power;
  }
  const size_t triangles = std::max<size_t>(stored_triangle_count(scene), 1);
  const size_t count = std::clamp<size_t>(most_triangles / triangles, 1, most);
  if (all.size() <= count) return all;
  std::vector<double> ranks;
  for (const Dimmer& d : all) ranks.push_back(rank(d));
  std::vector<double> sorted = ranks;
  std::sort(sorted.begin(), sorted.end(), std::greater<>());
  std::vector<Dimmer> kept;
  Dimmer rest;
  for (size_t i = 0; i < all.size(); ++i) {
    // Equal ranks keep their order of appearance.
    if (kept.size() + 1 < count && (count > 1 && ranks[i] >= sorted[count - 2])) {
      kept.push_back(std::move(all[i]));
    } else {
      rest.lights.push_back(all[i].name);
      rest.power += all[i].power;
    }
  }
  rest.name = std::to_string(rest.lights.size()) + (kept.empty() ? " luminaires" : " others");
  kept.push_back(std::move(rest));
  return kept;
}

Lighting::Lighting(Scene scene)
    : scene_(std::make_unique<Scene>(std::move(scene))),
      dimmers_(dimmers_of(*scene_, most_dimmers)),
      is_photometric_(scene_->is_photometric),
      cameras_(scene_->cameras),
      origin_(scene_->origin),
      bounds_(bounds_in_file(*scene_)),
      by_dimmer_(dimmers_.size()) {}

void Lighting::before_preparing(const std::function<void(const Scene&)>& look) {
  const std::lock_guard lock(mutex_);
  if (!whole_) look(*scene_);
}

std::shared_ptr<const PreparedScene> Lighting::whole() {
  const std::lock_guard lock(mutex_);
  if (!whole_) whole_ = std::make_shared<const PreparedScene>(std::move(*scene_));
  return whole_;
}

std::shared_ptr<const PreparedScene> Lighting::dimmer(size_t number) {
  const std::shared_ptr<const PreparedScene> all = whole();
  const std::lock_guard lock(mutex_);
  std::shared_ptr<const PreparedScene>& one = by_dimmer_[number];
  if (!one && dimmers_.size() == 1) one = all;
  if (!one) {
    DimmerSettings alone(dimmers_.size(), Rgb{0});
    alone[number] = Rgb{1};
    one = scaled(all, alone);
  }
  return one;
}

std::shared_ptr<const PreparedScene> Lighting::dimmed(const DimmerSettings& settings) {
  return scaled(whole(), settings);
}

std::shared_ptr<const PreparedScene> Lighting::scaled(
    const std::shared_ptr<const PreparedScene>& all, const DimmerSettings& settings) const {
  std::vector<Rgb> factors;
  for (const Light& light : all->scene.lights) {
    const auto has_light = [&](const Dimmer& d) {
      return std::find(d.lights.begin(), d.lights.end(), light.name) != d.lights.end();
    };
    const auto at = std::find_if(dimmers_.begin(), dimmers_.end(), has_light);
    factors.push_back(settings[size_t(at - dimmers_.begin())]);
  }
  return std::make_shared<const PreparedScene>(with_scaled_lights(all->scene, factors), all);
}

}  // namespace troffer
