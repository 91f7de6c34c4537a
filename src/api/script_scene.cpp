#include "api/script_scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/error.h"
#include "base/suggestion.h"
#include "base/wildcard.h"
#include "import/import.h"
#include "import/recentre.h"
#include "render/framing.h"
#include "scene/joined_lights.h"
#include "scene/names.h"
#include "scene/orientation.h"

namespace troffer {

ScriptScene::ScriptScene(const std::string& file, const ImportOptions& options)
    : scene_(with_joined_lights(import_scene(file, options))), options_(options) {
  for (const Light& e : scene_.lights) dimmed_.push_back({e.radiance, e.sky.ground});
}

ScriptScene::ScriptScene(const Vec3& up, bool is_photometric) : up_(up) {
  scene_.is_photometric = is_photometric;
}

Scene& ScriptScene::change() {
  prepared_ = nullptr;
  is_changed_ = true;
  return scene_;
}

ScriptScene::Extent ScriptScene::extent() const {
  const Scene& s = scene_;
  return {s.origin,           s.meshes.size(),   s.instanced_meshes.size(),
          s.instances.size(), s.spheres.size(),  s.disks.size(),
          s.materials.size(), s.textures.size(), s.environments.size(),
          s.webs.size(),      s.lights.size(),   s.cameras.size(),
          s.warnings};
}

void ScriptScene::restore(Extent&& before) {
  const auto shorten = [](auto& list, size_t size) {
    list.erase(list.begin() + std::ptrdiff_t(std::min(size, list.size())), list.end());
  };
  Scene& s = change();
  s.origin = before.origin;
  shorten(s.meshes, before.meshes);
  shorten(s.instanced_meshes, before.instanced_meshes);
  shorten(s.instances, before.instances);
  shorten(s.spheres, before.spheres);
  shorten(s.disks, before.disks);
  shorten(s.materials, before.materials);
  shorten(s.textures, before.textures);
  shorten(s.environments, before.environments);
  shorten(s.webs, before.webs);
  shorten(s.lights, before.lights);
  shorten(s.cameras, before.cameras);
  shorten(dimmed_, before.lights);
  s.warnings = std::move(before.warnings);
}

// A new light takes the dimmer of older lights of its name.
void ScriptScene::note_new_lights() {
  const size_t known = dimmed_.size();
  for (size_t i = known; i < scene_.lights.size(); ++i) {
    Dimmed d{scene_.lights[i].radiance, scene_.lights[i].sky.ground};
    for (size_t k = 0; k < known; ++k)
      if (scene_.lights[k].name == scene_.lights[i].name) d.dimmer = dimmed_[k].dimmer;
    dimmed_.push_back(d);
  }
  apply_dimmers();
}

Vec3 ScriptScene::up() const {
  return up_ ? *up_ : decide_up(scene_).up;
}

void ScriptScene::settle_origin(const Boxd& box) {
  const auto has_place = [](const Light& e) {
    return e.kind == LightKind::point || e.kind == LightKind::spot || has_surface(e.kind);
  };
  const bool is_new = up_ && scene_.meshes.empty() && scene_.spheres.empty() &&
                      scene_.disks.empty() && scene_.cameras.empty() &&
                      std::none_of(scene_.lights.begin(), scene_.lights.end(), has_place);
  if (is_new) change().origin = choose_origin(box);
}

std::vector<std::string> ScriptScene::light_names() const {
  std::vector<std::string> names;
  for (const Light& e : scene_.lights)
    if (std::find(names.begin(), names.end(), e.name) == names.end()) names.push_back(e.name);
  return names;
}

std::vector<size_t> ScriptScene::lights_named(const std::string& name) const {
  std::vector<size_t> found;
  for (size_t i = 0; i < scene_.lights.size(); ++i)
    if (scene_.lights[i].name == name) found.push_back(i);
  if (found.empty())
    throw UsageError("no light is named '" + name + "'" + did_you_mean(name, light_names()));
  return found;
}

double ScriptScene::dimmer(const std::string& name) const {
  return dimmed_[lights_named(name).front()].dimmer;
}

void ScriptScene::set_dimmer(const std::string& name, double dimmer) {
  set_dimmers(lights_named(name), dimmer);
}

void ScriptScene::dim(const std::string& pattern, double dimmer) {
  std::vector<size_t> found;
  for (size_t i = 0; i < scene_.lights.size(); ++i)
    if (fits_wildcard(scene_.lights[i].name, pattern)) found.push_back(i);
  set_dimmers(found.empty() ? lights_named(pattern) : found, dimmer);
}

void ScriptScene::set_dimmers(const std::vector<size_t>& lights, double dimmer) {
  if (!std::isfinite(dimmer) || dimmer < 0)
    throw UsageError("a dimmer is a finite number, at least 0");
  for (const size_t i : lights) dimmed_[i].dimmer = dimmer;
  apply_dimmers();
}

Rgb ScriptScene::radiance(const std::string& name) const {
  return dimmed_[lights_named(name).front()].radiance;
}

void ScriptScene::set_radiance(const std::string& name, Rgb radiance) {
  if (!is_finite(radiance) || std::min({radiance.r, radiance.g, radiance.b}) < 0)
    throw UsageError("a radiance is three finite numbers, at least 0");
  for (const size_t i : lights_named(name)) dimmed_[i].radiance = radiance;
  apply_dimmers();
}

void ScriptScene::apply_dimmers() {
  prepared_ = nullptr;
  for (size_t i = 0; i < dimmed_.size(); ++i) {
    const auto dimmer = float(dimmed_[i].dimmer);
    scene_.lights[i].radiance = dimmed_[i].radiance * dimmer;
    scene_.lights[i].sky.ground = dimmed_[i].ground * dimmer;
  }
}

size_t ScriptScene::material_named(const std::string& name) const {
  const auto is_it = [&](const Material& m) { return m.name == name; };
  const auto& all = scene_.materials;
  const auto found = std::find_if(all.begin(), all.end(), is_it);
  if (found == all.end())
    throw UsageError("no material is named '" + name + "'" +
                     did_you_mean(name, material_names(scene_)));
  if (std::find_if(found + 1, all.end(), is_it) != all.end())
    throw UsageError("several materials are named '" + name + "'");
  return size_t(found - all.begin());
}

void ScriptScene::add_sky(const SkyRequest& request, double north_deg) {
  append([&] {
    Scene& scene = change();
    troffer::add_sky(scene, request, make_compass(up(), north_deg, is_mirrored(scene_)));
    note_new_lights();
  });
}

void ScriptScene::add_light(const DaylightOptions& options) {
  Scene changed = scene_;
  std::map<std::string, double> dimmers;
  for (size_t i = 0; i < dimmed_.size(); ++i) {
    changed.lights[i].radiance = dimmed_[i].radiance;
    dimmers[changed.lights[i].name] = dimmed_[i].dimmer;
  }
  if (up_ && options.up.empty())
    add_daylight(changed, options, requested_up(*up_));
  else
    add_daylight(changed, options);
  changed = with_joined_lights(std::move(changed));
  std::vector<Dimmed> dimmed;
  for (const Light& e : changed.lights) {
    const auto known = dimmers.find(e.name);
    dimmed.push_back({e.radiance, e.sky.ground, known == dimmers.end() ? 1 : known->second});
  }
  scene_ = std::move(changed);
  dimmed_ = std::move(dimmed);
  apply_dimmers();
}

Camera ScriptScene::camera(const std::string& name) {
  for (const Camera& c : scene_.cameras)
    if (name.empty() || c.name == name) return c;
  if (!name.empty())
    throw UsageError("no camera is named '" + name + "'" +
                     did_you_mean(name, camera_names(scene_)));
  return framing_camera(*prepared(), up());
}

std::shared_ptr<const PreparedScene> ScriptScene::prepared() {
  if (prepared_) return prepared_;
  if (bounds(scene_).is_empty() && scene_.lights.empty())
    throw UsageError("the scene is empty: it has neither surfaces nor lights");
  // Lights of files were joined when the file was loaded.
  prepared_ = std::make_shared<const PreparedScene>(up_ ? with_joined_lights(scene_) : scene_);
  return prepared_;
}

}  // namespace troffer
