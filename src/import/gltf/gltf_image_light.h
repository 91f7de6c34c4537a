// glTF's image-based lights.
// References: [1] glTF extension EXT_lights_image_based.
#pragma once

#include "import/gltf/gltf_accessor.h"
#include "import/gltf/gltf_json.h"
#include "scene/scene.h"

namespace troffer {

// Adds the light that the shown scene's extension asks for, from the first of its cube maps: PNG
// with alpha is RGBD, all else what it looks like, a value of 1 being 1 cd/m². The coefficients of
// its irradiance are left aside: what the image sends is known. A warning, and nothing, where an
// image cannot be had.
void add_gltf_image_light(const JsonNode& root, const GltfBuffers& buffers, Scene& scene);

}  // namespace troffer
