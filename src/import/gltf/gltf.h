// glTF 2.0 files (.gltf, .glb) -> Scene.
// References: [1] Khronos, glTF 2.0 Specification, 2021.
#pragma once

#include <string>

#include "import/import_options.h"
#include "scene/scene.h"

namespace troffer {

// Imports the default scene (without one, all root nodes). Instances are flattened: one mesh per
// node and mesh primitive, in world space, 60 million triangles at most. Emission is in cd/m².
// Fails with InputError at the line and column of the JSON value that is wrong; of a GLB these
// count within its JSON chunk.
//
// What becomes of each part of the format and of each extension stands in docs/formats.md; none is
// refused because a file requires it. Skins and morph targets stand as the nodes and weights of the
// file say, or as its animation has them at `options.time`.
Scene import_gltf(const std::string& path, const ImportOptions& options = {});

}  // namespace troffer
