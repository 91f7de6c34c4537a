// Conversion of glTF texture references (textureInfo) to textures of the scene. Used by the
// converters of materials and of baked light.
// References: [1] Khronos, glTF 2.0 Specification, §3.8 (Texture Data);
//   [2] Khronos extension KHR_texture_transform.
#pragma once

#include <cstdint>
#include <string>

#include "import/gltf/gltf_accessor.h"
#include "import/gltf/gltf_json.h"
#include "import/gltf/gltf_uv_sets.h"
#include "import/texture_loader.h"

namespace troffer {

// A texture of the scene, or the colour that replaces it.
struct GltfTextureUse {
  int32_t texture = no_texture;  // no_texture also if the image is missing (with a warning)
  Rgb stand_in{1};               // colour to use instead of a missing image
};

// Returns the name of an image in warnings, and its key in the texture loader.
std::string gltf_image_key(const JsonNode& image);

// Asks the loader to decode in advance the images that `node`, a material, refers to. Throws
// InputError if a reference is malformed; the same error recurs when the texture is used.
void expect_gltf_images(const JsonNode& root, const JsonNode& node, const GltfBuffers& buffers,
                        TextureLoader& loader);

// Returns the texture that `info`, a textureInfo [1] §5.30, names, with its sampler and transform
// [2]. `is_srgb` is true for colours, false for data. `sets` holds the texture coordinate sets of
// the material's meshes.
// An image that cannot be read gives a warning and a stand-in colour.
GltfTextureUse gltf_texture(const JsonNode& root, const JsonNode& info, bool is_srgb,
                            const GltfUvSets& sets, const GltfBuffers& buffers,
                            TextureLoader& loader, Scene& scene);

}  // namespace troffer
