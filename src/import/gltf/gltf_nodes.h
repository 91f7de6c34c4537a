// The node hierarchy: which nodes a scene shows, and where they stand.
// References: [1] Khronos, glTF 2.0 Specification, §3.5 (Scenes and Nodes).
#pragma once

#include <cstdint>
#include <vector>

#include "base/log.h"
#include "base/transform.h"
#include "import/gltf/gltf_animation.h"
#include "import/gltf/gltf_json.h"

namespace troffer {

struct GltfNode {
  uint32_t index = 0;      // into /nodes
  Affine world_from_node;  // metres
};

struct GltfNodes {
  // The nodes of the default scene (of scene 0 if none is named, all roots if there is no scene),
  // parents before children, siblings in order of appearance. What a scene lists though it is no
  // root, or twice, is shown once, where its ancestors place it, with a warning.
  std::vector<GltfNode> shown;
  std::vector<Affine> world;  // of all nodes of the file: world from node
};

// Nodes stand as `poses` say, others as the file has them. Fails where any node of the file has two
// parents, is its own ancestor, or has a matrix that is not affine.
GltfNodes gltf_nodes(const JsonNode& root, const GltfPoses& poses, WarningLog& warnings);

}  // namespace troffer
