// glTF 2.0 files (.gltf, .glb) -> Scene.
// References: [1] Khronos, glTF 2.0 Specification, 2021.
#pragma once

#include <string>

#include "scene/scene.h"

namespace troffer {

// Imports the default scene (without one, all root nodes). Instances are flattened: one mesh per
// node and mesh primitive, in world space, 60 million triangles at most. Emission is in cd/m².
// Fails with InputError at the line and column of the JSON value that is wrong; of a GLB these
// count within its JSON chunk.
//
// Besides the core format: KHR_draco_mesh_compression, EXT_meshopt_compression, EXT_texture_webp,
// EXT_mesh_gpu_instancing, KHR_lights_punctual, KHR_materials_emissive_strength, _specular, _ior,
// _transmission, _volume, KHR_texture_transform, KHR_mesh_quantization. Another extension is a
// warning, also where the file requires it. Also with a warning each: alphaMode BLEND is shown as
// MASK at 0.5, a missing or broken image as grey, textures of one material with different sets of
// coordinates with the first one's set; left out are points, lines, vertex colours, attenuation
// inside volumes, and triangles that cannot be drawn. Skins and morph targets stand as the nodes
// and weights of the file say; animations are not played.
Scene import_gltf(const std::string& path);

}  // namespace troffer
