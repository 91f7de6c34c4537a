// Which sets of texture coordinates a glTF material looks its textures up by.
#pragma once

#include "base/log.h"
#include "import/gltf/gltf_json.h"

namespace troffer {

// A mesh keeps two at most: n of the TEXCOORD_n that becomes Mesh::uvs, and of that which becomes
// Mesh::uvs_2 (-1: none). Alpha and lights know the first alone.
struct GltfUvSets {
  int first = 0, second = -1;
};

// The set that a textureInfo names, or its KHR_texture_transform, which overrides it.
int gltf_uv_set(const JsonNode& texture_info);

// What cannot be had with two is told: those textures get the first.
GltfUvSets gltf_uv_sets(const JsonNode& material, WarningLog& warnings);

}  // namespace troffer
