// glTF's measured luminaires.
// References: [1] glTF extension EXT_lights_ies.
#pragma once

#include <string>

#include "base/transform.h"
#include "import/gltf/gltf_accessor.h"
#include "import/gltf/gltf_json.h"
#include "scene/scene.h"

namespace troffer {

// Adds the point that a node's extension `instance` asks for: a profile of the document's list, in
// a file beside it, a data URI or a buffer view, shining down the node's -Z, its half-plane C0
// towards X [1]. A warning, and nothing, where the node leaves no direction; InputError for
// profiles that cannot be read.
void add_gltf_ies_light(const JsonNode& root, const JsonNode& instance,
                        const Affine& world_from_node, const std::string& node_name,
                        const GltfBuffers& buffers, Scene& scene);

}  // namespace troffer
