// The node hierarchy: which nodes a scene shows, and where they stand.
// References: [1] Khronos, glTF 2.0 Specification, §3.5 (Scenes and Nodes).
#pragma once

#include <cstdint>
#include <vector>

#include "base/log.h"
#include "base/transform.h"
#include "import/gltf_json.h"

namespace troffer {

struct GltfNode {
  uint32_t index = 0;      // into /nodes
  Affine world_from_node;  // metres
};

// The nodes of the default scene (of scene 0 if none is named, all roots if there is no scene),
// parents before children, siblings in order of appearance. Fails where any node of the file has
// two parents, is its own ancestor, or has a matrix that is not affine.
std::vector<GltfNode> gltf_nodes(const JsonNode& root, WarningLog& warnings);

}  // namespace troffer
