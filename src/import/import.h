// Import of scene files: glTF 2.0 (.gltf, .glb), pbrt-v4 (.pbrt), Wavefront OBJ (.obj), Mitsuba
// (.xml), Radiance (.rad), Honeybee (.hbjson, .json), STL and PLY meshes. The ending selects the
// format; a final ".gz" is allowed. Unusable content throws InputError with file, line and column.
// Unsupported or suspicious content adds a warning to Scene::warnings, which counts equal ones.
#pragma once

#include <string>

#include "import/import_options.h"
#include "scene/scene.h"

namespace troffer {

// Imports a scene, instances repeated meshes, and replaces thin glass bodies by sheets. Throws
// UsageError if `options` use a feature of glTF for another format.
Scene import_scene(const std::string& path, const ImportOptions& options = {});

}  // namespace troffer
