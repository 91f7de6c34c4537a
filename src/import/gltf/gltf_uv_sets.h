// Choice of the texture coordinate sets (TEXCOORD_n) that a glTF material uses. A mesh of the scene
// has two sets at most, so a material with more is approximated. Used when a material is read
// (gltf_material.h) and when its meshes are made (gltf_mesh.h).
#pragma once

#include "base/log.h"
#include "import/gltf/gltf_json.h"

namespace troffer {

// Values of n for the TEXCOORD_n that become Mesh::uvs and Mesh::uvs_2 (-1: none). Alpha and
// emission use the first set only.
struct GltfUvSets {
  int first = 0, second = -1;
};

// Returns the set that a textureInfo names; its KHR_texture_transform overrides it.
int gltf_uv_set(const JsonNode& texture_info);

// Chooses the sets of a material. Warns if two sets do not suffice; the remaining textures then use
// the first set.
GltfUvSets gltf_uv_sets(const JsonNode& material, WarningLog& warnings);

}  // namespace troffer
