// Image-based environment lights of glTF files. gltf.cpp calls it once, for the scene that is
// shown. The cube map becomes an equal-area environment image of at most 2048 × 2048 texels, in
// cd/m².
// References: [1] glTF extension EXT_lights_image_based.
#pragma once

#include "import/gltf/gltf_accessor.h"
#include "import/gltf/gltf_json.h"
#include "scene/scene.h"

namespace troffer {

// Adds the environment light of the default scene's extension, from the first (sharpest) of its
// cube maps. PNG with alpha is decoded as RGBD; a value of 1 means 1 cd/m². Ignores the irradiance
// coefficients, because the image determines them.
// Adds nothing, with a warning, if an image cannot be read. Throws InputError if the extension is
// malformed.
void add_gltf_image_light(const JsonNode& root, const GltfBuffers& buffers, Scene& scene);

}  // namespace troffer
