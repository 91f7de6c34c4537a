// Window groups and their states, which a user describes for scenes whose format has none: a JSON
// file that names nodes of the scene (docs/reference/annual.md). Honeybee models bring their own.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "annual/fabric.h"
#include "scene/scene.h"

namespace troffer {

// Patterns of names may hold '*' (base/wildcard.h).
struct WindowState {
  std::string name;
  std::vector<std::string> shown;  // nodes, such as blinds; absent in states that do not name them
  double transmittance = 1;        // factor on the light that the windows transmit
  std::string material;            // of the windows in this state; empty: their own
  std::string fabric;              // of the shown nodes (WindowGroups::fabrics); empty: their own
};
struct WindowGroup {
  std::string name;
  std::vector<std::string> windows;  // nodes that let light in; black for light of other groups
  std::vector<WindowState> states;   // at least one
};

// Contents of a file.
struct WindowGroups {
  std::vector<WindowGroup> groups;
  std::vector<Fabric> fabrics;
};

// Reads the file. Throws InputError with line and column for other contents.
WindowGroups read_window_groups(const std::string& path);

// Throws UsageError for names that fit nothing in the scene, for windows of several groups, and for
// transmittances of windows that have no transmission to scale.
void check_window_groups(const Scene& scene, const std::vector<WindowGroup>& groups);

// Returns the scene with group g in state states[g]. If that is empty, the group's windows are
// black and its shown nodes absent. Light sources are removed, since indices of lights refer to
// meshes.
Scene with_window_states(Scene scene, const WindowGroups& groups,
                         std::span<const std::optional<size_t>> states);

}  // namespace troffer
