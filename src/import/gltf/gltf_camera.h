// glTF cameras.
// References: [1] Khronos, glTF 2.0 Specification, §3.10 (Cameras).
#pragma once

#include <optional>
#include <string>

#include "base/log.h"
#include "base/transform.h"
#include "import/gltf/gltf_json.h"
#include "scene/scene.h"

namespace troffer {

// The camera that `camera` (an element of /cameras) describes, looking down -Z of its node. Scale
// and shear of the node are taken out. A node that leaves no direction to look in gives a warning
// and nothing; impossible angles and sizes fail.
std::optional<Camera> gltf_camera(const JsonNode& camera, const Affine& world_from_node,
                                  const std::string& name, WarningLog& warnings);

}  // namespace troffer
