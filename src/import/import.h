// Files -> Scene: glTF 2.0 (.gltf, .glb), pbrt-v4 (.pbrt), Wavefront OBJ (.obj), Mitsuba (.xml),
// Radiance (.rad), STL and PLY meshes, chosen by ending. Everything that cannot be used throws
// InputError with file, line and column; everything that is merely odd becomes a counted warning in
// Scene::warnings.
#pragma once

#include <string>

#include "import/import_options.h"
#include "scene/scene.h"

namespace troffer {

// UsageError where `options` ask for what a format does not have: all are glTF's.
Scene import_scene(const std::string& path, const ImportOptions& options = {});

}  // namespace troffer
