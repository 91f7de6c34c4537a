// PLY files (.ply) as scenes of their own.
#pragma once

#include <string>

#include "import/read_progress.h"
#include "scene/scene.h"

namespace troffer {

// One diffuse grey mesh without light and camera, in the file's units: what read_ply() reads.
Scene import_ply(const std::string& path, const TellProgress& progress = {});

}  // namespace troffer
