// Conversion of glTF mesh primitives to meshes. gltf.cpp calls it once per placed primitive, or
// once in the mesh's own space for instances.
// References: [1] Khronos, glTF 2.0 Specification, §3.7 (Geometry).
#pragma once

#include <vector>

#include "base/log.h"
#include "base/transform.h"
#include "import/gltf/gltf_primitive.h"
#include "import/gltf/gltf_uv_sets.h"
#include "import/recentre.h"
#include "scene/scene.h"

namespace troffer {

// Transform, morph weights and joints of a mesh.
struct GltfPose {
  Affine world_from_mesh;
  std::vector<double> target_weights;  // weights of morph targets; missing ones are 0
  std::vector<Affine> joints;          // world from mesh, per joint of the skin; empty: no skin
};

// Returns the primitive in world space, with only the vertices that its triangles use.
// Leaves out triangles without area or with vertices that are not finite, and warns. Under a
// mirroring transform it reverses the winding, so that fronts stay fronts [1] §3.7.4. If all
// normals contradict the winding, it follows the normals and warns.
// `sets` selects the TEXCOORD_n that become Mesh::uvs and uvs_2; missing sets stay empty. `bounds`
// grows by the triangles. `colors` receives the vertex colours, if there are any.
Mesh make_gltf_mesh(const GltfPrimitive& primitive, const GltfPose& pose, const GltfUvSets& sets,
                    WarningLog& warnings, PlacedBounds& bounds,
                    std::vector<TextureValue>* colors = nullptr);

}  // namespace troffer
