// pbrt-v4 scene files.
//
// References: [1] pbrt-v4 Input File Format, pbrt.org/fileformat-v4.
#pragma once

#include <string>

#include "import/image_use.h"
#include "scene/scene.h"

namespace troffer {

// The scene a .pbrt file describes, in its own (left-handed) world; emission in W/(m² sr).
// Files it names are looked up in its folder and never outside. Shapes, materials, textures and
// lights that are not supported are warnings that name them. Lights are called emitter0,
// emitter1 … in the order of the shapes that emit.
// The front of a surface, which alone emits unless the light is twosided, is the side of pbrt's
// surface normal [1]: per-vertex normals decide where a mesh has some, else its winding or, for
// quadrics, the outside (disk: +z); ReverseOrientation turns it, and so does a transform that
// mirrors (but not where there are per-vertex normals).
// InputError: with line and column, for anything malformed.
Scene import_pbrt(const std::string& path, ImageUse images = ImageUse::read);

}  // namespace troffer
