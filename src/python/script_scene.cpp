#include "python/script_scene.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <thread>

#include "base/error.h"
#include "import/import.h"
#include "render/framing.h"
#include "scene/joined_lights.h"
#include "scene/orientation.h"

namespace troffer {

ScriptScene::ScriptScene(const std::string& file, const ImportOptions& options)
    : scene_(with_joined_lights(import_scene(file, options))) {
  for (const Light& e : scene_.lights) dimmed_.push_back({e.radiance});
}

Scene& ScriptScene::change() {
  prepared_ = nullptr;
  return scene_;
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
  if (found.empty()) throw UsageError("no light is named '" + name + "'");
  return found;
}

double ScriptScene::dimmer(const std::string& name) const {
  return dimmed_[lights_named(name).front()].dimmer;
}

void ScriptScene::set_dimmer(const std::string& name, double dimmer) {
  if (!std::isfinite(dimmer) || dimmer < 0)
    throw UsageError("a dimmer must be a finite number, at least 0");
  for (const size_t i : lights_named(name)) dimmed_[i].dimmer = dimmer;
  apply_dimmers();
}

Rgb ScriptScene::radiance(const std::string& name) const {
  return dimmed_[lights_named(name).front()].radiance;
}

void ScriptScene::set_radiance(const std::string& name, Rgb radiance) {
  if (!is_finite(radiance) || std::min({radiance.r, radiance.g, radiance.b}) < 0)
    throw UsageError("a radiance must be three finite numbers, each at least 0");
  for (const size_t i : lights_named(name)) dimmed_[i].radiance = radiance;
  apply_dimmers();
}

void ScriptScene::apply_dimmers() {
  Scene& scene = change();
  for (size_t i = 0; i < dimmed_.size(); ++i)
    scene.lights[i].radiance = dimmed_[i].radiance * float(dimmed_[i].dimmer);
}

size_t ScriptScene::material_named(const std::string& name) const {
  const auto is_it = [&](const Material& m) { return m.name == name; };
  const auto& all = scene_.materials;
  const auto found = std::find_if(all.begin(), all.end(), is_it);
  if (found == all.end()) throw UsageError("no material is named '" + name + "'");
  if (std::find_if(found + 1, all.end(), is_it) != all.end())
    throw UsageError("several materials are named '" + name + "'");
  return size_t(found - all.begin());
}

void ScriptScene::add_sky(const SkyRequest& request, Vec3 up, double north_deg) {
  Scene& scene = change();
  troffer::add_sky(scene, request, make_compass(up, north_deg, is_mirrored(scene_)));
  for (size_t i = dimmed_.size(); i < scene.lights.size(); ++i)
    dimmed_.push_back({scene.lights[i].radiance});
}

void ScriptScene::add_light(const DaylightOptions& options) {
  Scene changed = scene_;
  std::map<std::string, double> dimmers;
  for (size_t i = 0; i < dimmed_.size(); ++i) {
    changed.lights[i].radiance = dimmed_[i].radiance;
    dimmers[changed.lights[i].name] = dimmed_[i].dimmer;
  }
  add_daylight(changed, options);
  change() = with_joined_lights(std::move(changed));
  dimmed_.clear();
  for (const Light& e : scene_.lights) {
    const auto known = dimmers.find(e.name);
    dimmed_.push_back({e.radiance, known == dimmers.end() ? 1 : known->second});
  }
  apply_dimmers();
}

Camera ScriptScene::camera(const std::string& name) {
  for (const Camera& c : scene_.cameras)
    if (name.empty() || c.name == name) return c;
  if (!name.empty()) throw UsageError("no camera is named '" + name + "'");
  return framing_camera(*prepared(), decide_up(scene_).up);
}

std::shared_ptr<const PreparedScene> ScriptScene::prepared() {
  if (!prepared_) prepared_ = std::make_shared<const PreparedScene>(scene_);
  return prepared_;
}

namespace {

// Lets a thread wait until the work has ended.
class Ending {
 public:
  void announce() {
    const std::lock_guard lock(mutex_);
    has_ended_ = true;
    changed_.notify_all();
  }
  bool wait() {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::milliseconds(50), [&] { return has_ended_; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool has_ended_ = false;
};

}  // namespace

void run_watched(const std::function<void(const StopFlag& stop)>& work,
                 const std::function<void()>& look) {
  StopFlag stop{false};
  Ending ending;
  std::exception_ptr of_work, of_look;
  std::thread worker([&] {
    try {
      work(stop);
    } catch (...) {
      of_work = std::current_exception();
    }
    ending.announce();
  });
  for (bool has_ended = false; !has_ended;) {
    has_ended = ending.wait();
    if (of_look) continue;
    try {
      look();
    } catch (...) {
      of_look = std::current_exception();
      stop = true;
    }
  }
  worker.join();
  if (of_look) std::rethrow_exception(of_look);
  if (of_work) std::rethrow_exception(of_work);
}

}  // namespace troffer
