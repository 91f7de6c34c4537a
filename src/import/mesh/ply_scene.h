// Import of PLY files (.ply) as scenes of their own, by import_scene(). Other formats that name PLY
// meshes call read_ply() directly.
#pragma once

#include <string>

#include "import/read_progress.h"
#include "scene/scene.h"

namespace troffer {

// Imports one diffuse grey mesh, without lights and cameras, in the file's units. read_ply() lists
// the content and the errors.
Scene import_ply(const std::string& path, const TellProgress& progress = {});

}  // namespace troffer
