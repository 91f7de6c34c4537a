// Names in a scene that options refer to, each once, in file order. Used to match options, to list
// names, and for error messages that suggest the nearest name.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace troffer {

std::vector<std::string> light_names(const Scene& scene);
std::vector<std::string> camera_names(const Scene& scene);
std::vector<std::string> material_names(const Scene& scene);
// Names of meshes and instances, then of lights.
std::vector<std::string> node_names(const Scene& scene);

// "no light is named 'lmap'; did you mean 'lamp'? (troffer info lists them)".
std::string no_light_named(const Scene& scene, const std::string& name);
std::string no_camera_named(const Scene& scene, const std::string& name);
// "nothing is named 'dsek'; did you mean 'desk'?".
std::string no_node_named(const Scene& scene, const std::string& name);

}  // namespace troffer
