// How the meshes of glTF nodes stand: joints of skins, weights of morph targets, instances.
// References: [1] Khronos, glTF 2.0 Specification, §3.7.2.2, §3.7.3; [2] Khronos extension
//   EXT_mesh_gpu_instancing.
#pragma once

#include <vector>

#include "base/transform.h"
#include "import/gltf/gltf_accessor.h"
#include "import/gltf/gltf_json.h"

namespace troffer {

// Per joint of a skin: world from mesh, by the world transforms of all nodes.
std::vector<Affine> gltf_joints(const JsonNode& skin, const GltfBuffers& buffers,
                                const std::vector<Affine>& world_of_nodes);

// The node's weights, or else the mesh's.
std::vector<double> gltf_target_weights(const JsonNode& node, const JsonNode& mesh);

// Where a node's mesh stands, in terms of the node: once as it is, or as often as [2] says.
std::vector<Affine> gltf_instances(const JsonNode& node, const GltfBuffers& buffers);

// Rotation of a quaternion (x, y, z, w) of any length but zero; fails at `where` for zero.
Affine gltf_rotation(const JsonNode& where, double x, double y, double z, double w);

}  // namespace troffer
