// glTF's lights without surface.
// References: [1] Khronos, glTF extension KHR_lights_punctual.
#pragma once

#include <optional>
#include <string>

#include "base/log.h"
#include "base/transform.h"
#include "import/gltf/gltf_json.h"
#include "scene/light.h"

namespace troffer {

// The light that `light` (an element of the extension's lights) describes, shining down -Z of its
// node: directional (lx), point or spot (cd) [1]. Nothing, and a warning, where its node leaves no
// direction; fails on types, colours, angles and ranges that cannot be.
std::optional<Light> gltf_light(const JsonNode& light, const Affine& world_from_node,
                                const std::string& name, WarningLog& warnings);

}  // namespace troffer
