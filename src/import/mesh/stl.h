// STL files (.stl), binary and text -> Scene.
#pragma once

#include <string>

#include "import/read_progress.h"
#include "scene/scene.h"

namespace troffer {

// One diffuse grey mesh without light and camera, in the file's units; normals in the file are not
// looked at: the order of the corners says which side is the front. InputError where a text is
// malformed or a binary file is shorter than its count of triangles says.
Scene import_stl(const std::string& path, const PieceReading& how = {});

}  // namespace troffer
