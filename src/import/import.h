// Files -> Scene: glTF 2.0 (.gltf, .glb), pbrt-v4 (.pbrt), Wavefront OBJ (.obj), Mitsuba (.xml),
// Radiance (.rad), chosen by ending. Everything that cannot be used throws InputError with file,
// line and column; everything that is merely odd becomes a counted warning in Scene::warnings.
#pragma once

#include <string>

#include "scene/scene.h"

namespace troffer {

Scene import_scene(const std::string& path);

}  // namespace troffer
