// The node hierarchy of a glTF file: which nodes are shown, and their world transforms. gltf.cpp
// places meshes, lights and cameras by it; skins need the transforms of all nodes.
// References: [1] Khronos, glTF 2.0 Specification, §3.5 (Scenes and Nodes).
#pragma once

#include <cstdint>
#include <vector>

#include "base/log.h"
#include "base/transform.h"
#include "import/gltf/gltf_animation.h"
#include "import/gltf/gltf_json.h"

namespace troffer {

// A node that is shown, with its world transform.
struct GltfNode {
  uint32_t index = 0;      // into /nodes
  Affine world_from_node;  // metres
};

struct GltfNodes {
  // Nodes of the default scene: the named one, else scene 0, else all roots. Parents come before
  // children, siblings in the order of the file. Hidden nodes are left out with their descendants.
  // A node that a scene lists twice, or that is not a root, is shown once, where its ancestors
  // place it, with a warning.
  std::vector<GltfNode> shown;
  std::vector<Affine> world;  // world from node, for all nodes of the file
};

// Computes the transforms. `poses` replaces the transforms of the nodes that it contains. Fails if
// any node has two parents, is its own ancestor, or has a matrix that is not affine.
GltfNodes gltf_nodes(const JsonNode& root, const GltfPoses& poses, WarningLog& warnings);

}  // namespace troffer
