// Import of STL files (.stl), binary and text, by import_scene(). Equal corners are welded to
// shared vertices. The length of the file, not the word "solid", tells binary files from texts.
#pragma once

#include <string>

#include "import/read_progress.h"
#include "scene/scene.h"

namespace troffer {

// Imports one diffuse grey mesh, without lights and cameras, in the file's units. Ignores the
// normals of the file: the order of the corners determines the front. Throws InputError if a text
// is malformed or a binary file is shorter than its triangle count requires.
Scene import_stl(const std::string& path, const PieceReading& how = {});

}  // namespace troffer
