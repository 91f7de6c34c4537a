// glTF 2.0 files (.gltf, .glb) -> Scene.
// References: [1] Khronos, glTF 2.0 Specification, 2021.
#pragma once

#include <string>

#include "scene/scene.h"

namespace troffer {

// Imports the default scene. Instances are flattened: one mesh per node and mesh primitive, in
// world space. Emission is in cd/m². Fails with InputError at the line and column of the JSON
// value that is wrong; see docs/formats.md for what is supported, shown otherwise or left out.
Scene import_gltf(const std::string& path);

}  // namespace troffer
