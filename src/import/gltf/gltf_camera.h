// Conversion of glTF cameras, perspective and orthographic, to cameras of the scene. gltf.cpp calls
// it for each node with a camera. Positions and sizes are in metres; near and far planes are
// ignored.
// References: [1] Khronos, glTF 2.0 Specification, §3.10 (Cameras).
#pragma once

#include <optional>
#include <string>

#include "base/log.h"
#include "base/transform.h"
#include "import/gltf/gltf_json.h"
#include "scene/scene.h"

namespace troffer {

// Returns the camera that `camera`, an element of /cameras, describes. It looks down -Z of its
// node; scale and shear of the node are removed.
// Returns nothing, with a warning, if the node's transform leaves no viewing direction. Fails on
// angles and sizes that are out of range.
std::optional<Camera> gltf_camera(const JsonNode& camera, const Affine& world_from_node,
                                  const std::string& name, WarningLog& warnings);

}  // namespace troffer
