#include "annual/path_scenes.h"

#include <algorithm>
#include <optional>

#include "annual/window_groups.h"
#include "base/error.h"
#include "import/import.h"
#include "scene/scaled_lights.h"

namespace troffer {

namespace {

std::shared_ptr<const PreparedScene> prepared(Scene scene) {
  return std::make_shared<const PreparedScene>(with_lights_off(std::move(scene)));
}

// Groups of a Honeybee model whose windows are computed apart.
std::vector<LightPath> paths_of_model(const SceneOrigin& origin, const Scene& shown) {
  std::vector<DynamicGroup> groups;
  ImportOptions all_black = origin.options;
  for (const DynamicGroup& g : shown.dynamic_groups) {
    if (!g.has_windows) continue;
    groups.push_back(g);
    all_black.blocked_groups.insert(g.name);
    all_black.states.erase(g.name);
  }
  if (groups.empty()) return {};
  std::vector<LightPath> paths{
      {static_path, {{"default", prepared(import_scene(origin.file, all_black))}}}};
  for (const DynamicGroup& g : groups) {
    LightPath& path = paths.emplace_back(LightPath{g.name, {}});
    const auto fixed = origin.options.states.find(g.name);
    for (size_t s = 0; s < g.states.size(); ++s) {
      if (fixed != origin.options.states.end() && fixed->second != s) continue;
      ImportOptions options = all_black;
      options.blocked_groups.erase(g.name);
      options.states[g.name] = s;
      path.states.push_back({g.states[s], prepared(import_scene(origin.file, options))});
    }
  }
  return paths;
}

std::vector<LightPath> paths_of_file(const Scene& shown, const std::string& file) {
  const WindowGroups all = read_window_groups(file);
  const std::vector<WindowGroup>& groups = all.groups;
  check_window_groups(shown, groups);
  std::vector<std::optional<size_t>> states(groups.size());
  std::vector<LightPath> paths{
      {static_path, {{"default", prepared(with_window_states(shown, all, states))}}}};
  for (size_t g = 0; g < groups.size(); ++g) {
    LightPath& path = paths.emplace_back(LightPath{groups[g].name, {}});
    for (size_t s = 0; s < groups[g].states.size(); ++s) {
      states[g] = s;
      path.states.push_back(
          {groups[g].states[s].name, prepared(with_window_states(shown, all, states))});
    }
    states[g].reset();
  }
  return paths;
}

}  // namespace

Scene with_lights_off(Scene scene) {
  const std::vector<Rgb> off(scene.lights.size(), Rgb{0});
  return with_scaled_lights(std::move(scene), off);
}

bool has_groups_of_model(const Scene& scene) {
  return std::any_of(scene.dynamic_groups.begin(), scene.dynamic_groups.end(),
                     [](const DynamicGroup& g) { return g.has_windows; });
}

std::vector<LightPath> annual_paths(const SceneOrigin& origin, const Scene& shown,
                                    const std::string& groups) {
  std::vector<LightPath> paths = paths_of_model(origin, shown);
  if (!groups.empty()) {
    if (!paths.empty()) throw UsageError("--groups: the model has window groups of its own");
    return paths_of_file(shown, groups);
  }
  if (paths.empty()) paths.push_back({static_path, {{"default", prepared(shown)}}});
  return paths;
}

}  // namespace troffer
