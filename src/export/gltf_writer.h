// Writes scenes as glTF 2.0 files.
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

// Writes `path`: a .glb with all data, or a .gltf with its data in `files`, the output folder of
// `path`. Emission is in cd/m², with 179 lm/W for scenes in W. Returns warnings about what the
// format or its materials cannot express. Throws EnvironmentError for files that cannot be written
// or exceed 4 GiB.
// - up: direction that becomes y.
// - baked: light for meshes and instances; null: none. Lightmaps use TEXCOORD_1, or TEXCOORD_2 for
//   meshes with a second set of their own.
std::vector<Warning> write_gltf(const Scene& scene, const Vec3& up, const std::string& path,
                                OutputFolder& files, const BakedLight* baked = nullptr);

}  // namespace troffer
