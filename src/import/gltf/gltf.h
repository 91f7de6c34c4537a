// Importer of glTF 2.0 files (.gltf and .glb) into a Scene. It reads meshes, instances, materials,
// lights, cameras, skins, morph targets and animations. docs/reference/formats.md lists what
// becomes of each part of the format and of each extension. Positions are in metres; emission is in
// cd/m² (the scene is photometric). References: [1] Khronos, glTF 2.0 Specification, 2021.
#pragma once

#include <string>

#include "import/import_options.h"
#include "scene/scene.h"

namespace troffer {

// Imports the default scene, or all root nodes if the file has no scene. Skins and morph targets
// are posed by the file's nodes and weights, or by the animation at `options.time`.
// Unsupported extensions give a warning, even where the file requires them.
// Throws InputError with the line and column of the JSON value that is wrong; in a GLB they count
// from the start of the JSON chunk. Throws it also where the scene exceeds the limits of
// import/limits.h.
Scene import_gltf(const std::string& path, const ImportOptions& options = {});

}  // namespace troffer
