// glTF mesh primitives -> meshes in world space.
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

// How a mesh stands in the world.
struct GltfPose {
  Affine world_from_mesh;
  std::vector<double> target_weights;  // of morph targets; missing ones are 0
  std::vector<Affine> joints;          // per joint of its skin, world from mesh; empty: no skin
};

// The primitive in world space, with the vertices that its triangles use. Triangles without area
// or with vertices that are not finite are left out, with a warning. Under a mirroring transform
// triangles are turned round, so that the front stays the front [1] §3.7.4; a mesh all of whose
// normals contradict its winding is wound by them, with a warning. `sets`: which TEXCOORD_n
// become Mesh::uvs and uvs_2 (none if they are not there). Counts its triangles into `bounds`.
// `colors` becomes those of the vertices, if they have any.
Mesh make_gltf_mesh(const GltfPrimitive& primitive, const GltfPose& pose, const GltfUvSets& sets,
                    WarningLog& warnings, PlacedBounds& bounds,
                    std::vector<TextureValue>* colors = nullptr);

}  // namespace troffer
