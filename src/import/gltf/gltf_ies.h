// Luminaires with photometric webs in glTF files. gltf.cpp calls this for each node that has the
// extension.
// References: [1] glTF extension EXT_lights_ies.
#pragma once

#include <string>

#include "base/transform.h"
#include "import/gltf/gltf_accessor.h"
#include "import/gltf/gltf_json.h"
#include "scene/scene.h"

namespace troffer {

// Adds the point light that `instance`, a node's extension object, describes. Its profile comes
// from the document's list: a file, a data URI or a buffer view. It shines down the node's -Z, with
// half-plane C0 towards X [1].
// Adds nothing, with a warning, if the node's transform leaves no direction. Throws InputError if
// the profile cannot be read.
void add_gltf_ies_light(const JsonNode& root, const JsonNode& instance,
                        const Affine& world_from_node, const std::string& node_name,
                        const GltfBuffers& buffers, Scene& scene);

}  // namespace troffer
