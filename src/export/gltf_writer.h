// Scenes -> glTF 2.0 files.
//
// References: [1] Khronos, "glTF 2.0 Specification", with KHR_lights_punctual,
//   KHR_materials_emissive_strength, _ior, _specular, _transmission, _volume,
//   KHR_texture_transform.
#pragma once

#include <string>
#include <vector>

#include "export/baked_light.h"
#include "scene/scene.h"

namespace troffer {

// Writes `path`: a .glb with all in it, or a .gltf and, beside it, a folder of its name with
// "_files" for its data. Emission is in cd/m², 179 lm/W for scenes in W. Returns what the format or
// its materials cannot hold, in words. EnvironmentError: what cannot be written, or is above 4 GiB.
// baked: light for its meshes and instances; null: none. Lightmaps go by TEXCOORD_1, or by
// TEXCOORD_2 for meshes that have a second set of their own.
std::vector<Warning> write_gltf(const Scene& scene, const std::string& path,
                                const BakedLight* baked = nullptr);

}  // namespace troffer
