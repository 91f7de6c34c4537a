// Poses of the meshes of glTF nodes: joints of skins, weights of morph targets, and instances.
// gltf.cpp combines them into a GltfPose for each placed mesh.
// References: [1] Khronos, glTF 2.0 Specification, §3.7.2.2, §3.7.3; [2] Khronos extension
//   EXT_mesh_gpu_instancing.
#pragma once

#include <vector>

#include "base/transform.h"
#include "import/gltf/gltf_accessor.h"
#include "import/gltf/gltf_json.h"

namespace troffer {

// Returns the transform of each joint of a skin, world from mesh. `world_of_nodes` holds the world
// transforms of all nodes.
std::vector<Affine> gltf_joints(const JsonNode& skin, const GltfBuffers& buffers,
                                const std::vector<Affine>& world_of_nodes);

// Returns the node's morph weights, or the mesh's if the node has none.
std::vector<double> gltf_target_weights(const JsonNode& node, const JsonNode& mesh);

// Returns the transforms of a node's mesh relative to the node: the identity, or those of [2].
std::vector<Affine> gltf_instances(const JsonNode& node, const GltfBuffers& buffers);

// Returns the rotation of the quaternion (x, y, z, w), normalised first. Fails at `where` if its
// length is zero or not finite.
Affine gltf_rotation(const JsonNode& where, double x, double y, double z, double w);

}  // namespace troffer
