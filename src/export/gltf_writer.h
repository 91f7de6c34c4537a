// Scenes -> glTF 2.0 files.
//
// References: [1] Khronos, "glTF 2.0 Specification", with KHR_lights_punctual,
//   KHR_materials_emissive_strength, _ior, _specular, _transmission, _volume,
//   KHR_texture_transform.
#pragma once

#include <string>
#include <vector>

#include "export/baked_light.h"
#include "export/output_folder.h"
#include "scene/scene.h"

namespace troffer {

// Writes `path`: a .glb with all in it, or a .gltf and its data in `files`, which are those of
// `path`. Emission is in cd/m², 179 lm/W for scenes in W. Returns what the format or
// its materials cannot hold, in words. EnvironmentError: what cannot be written, or is above 4 GiB.
// up: becomes y.
// baked: light for its meshes and instances; null: none. Lightmaps go by TEXCOORD_1, or by
// TEXCOORD_2 for meshes that have a second set of their own.
std::vector<Warning> write_gltf(const Scene& scene, const Vec3& up, const std::string& path,
                                OutputFolder& files, const BakedLight* baked = nullptr);

}  // namespace troffer
