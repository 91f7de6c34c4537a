// STL files (.stl), binary and text -> Scene.
#pragma once

#include <string>

#include "scene/scene.h"

namespace troffer {

// One diffuse grey mesh without light and camera, in the file's units; normals in the file are not
// looked at: the order of the corners says which side is the front. InputError where a text is
// malformed or a binary file is shorter than its count of triangles says. Text is read in pieces of
// about so many bytes side by side, to the same end; 0: in one.
Scene import_stl(const std::string& path, size_t piece_bytes = size_t(1) << 20);

}  // namespace troffer
