// One glTF texture reference -> a texture of the scene.
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

struct GltfTextureUse {
  int32_t texture = no_texture;  // none also where the image cannot be had (with a warning)
  Rgb stand_in{1};               // where an image cannot be had: what to take for it
};

// What stands for an image in warnings and for the loader.
std::string gltf_image_key(const JsonNode& image);

// Tells the loader that it will be asked for the images of the textures that `node`, a material,
// names. InputError where one is not as it should be: told when it is used, if it is.
void expect_gltf_images(const JsonNode& root, const JsonNode& node, const GltfBuffers& buffers,
                        TextureLoader& loader);

// The texture that `info` (a textureInfo [1] §5.30) names, with its sampler and transform [2].
// `is_srgb`: colour as against data. `sets`: what a mesh of its material has as texture
// coordinates. A URI that leads out of the scene's folder fails.
GltfTextureUse gltf_texture(const JsonNode& root, const JsonNode& info, bool is_srgb,
                            const GltfUvSets& sets, const GltfBuffers& buffers,
                            TextureLoader& loader, Scene& scene);

}  // namespace troffer
