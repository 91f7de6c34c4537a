#include "scene/names.h"

#include <unordered_set>

#include "base/suggestion.h"

namespace troffer {

namespace {

class Names {
 public:
  void add(const std::string& name) {
    if (!name.empty() && seen_.insert(name).second) names_.push_back(name);
  }
  template <class T>
  void add_all(const std::vector<T>& things) {
    for (const T& t : things) add(t.name);
  }
  std::vector<std::string> take() { return std::move(names_); }

 private:
  std::unordered_set<std::string> seen_;
  std::vector<std::string> names_;
};

template <class T>
std::vector<std::string> names_of(const std::vector<T>& things) {
  Names names;
  names.add_all(things);
  return names.take();
}

std::string none_named(const char* kind, const std::string& name,
                       const std::vector<std::string>& known) {
  return std::string(kind) + " is named '" + name + "'" + did_you_mean(name, known);
}

constexpr const char* listed = " (troffer info lists them)";

}  // namespace

std::vector<std::string> light_names(const Scene& scene) {
  return names_of(scene.lights);
}

std::vector<std::string> camera_names(const Scene& scene) {
  return names_of(scene.cameras);
}

std::vector<std::string> material_names(const Scene& scene) {
  return names_of(scene.materials);
}

std::vector<std::string> node_names(const Scene& scene) {
  Names names;
  names.add_all(scene.meshes);
  names.add_all(scene.instances);
  names.add_all(scene.lights);
  return names.take();
}

std::string no_light_named(const Scene& scene, const std::string& name) {
  return none_named("no light", name, light_names(scene)) + listed;
}

std::string no_camera_named(const Scene& scene, const std::string& name) {
  if (scene.cameras.empty()) return "no camera is named '" + name + "': the scene has none";
  return none_named("no camera", name, camera_names(scene)) + listed;
}

std::string no_node_named(const Scene& scene, const std::string& name) {
  return none_named("nothing", name, node_names(scene));
}

}  // namespace troffer
