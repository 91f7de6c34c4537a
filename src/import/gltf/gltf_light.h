// Conversion of glTF lights without surface: directional, point and spot. gltf.cpp calls it for
// each node with such a light. Illuminance is in lx, intensity in cd.
// References: [1] Khronos, glTF extension KHR_lights_punctual.
#pragma once

#include <optional>
#include <string>

#include "base/log.h"
#include "base/transform.h"
#include "import/gltf/gltf_json.h"
#include "scene/light.h"

namespace troffer {

// Returns the light that `light`, an element of the extension's lights, describes. It shines down
// -Z of its node: directional (lx), point or spot (cd) [1].
// Returns nothing, with a warning, if the type is unknown or the node's transform leaves no
// direction. Fails on colours, angles and ranges that are out of range.
std::optional<Light> gltf_light(const JsonNode& light, const Affine& world_from_node,
                                const std::string& name, WarningLog& warnings);

}  // namespace troffer
