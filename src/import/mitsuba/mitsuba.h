// Mitsuba scenes (.xml), versions 0.5 to 3.
//
// References: [1] W. Jakob et al., "Mitsuba 3 documentation"; [2] W. Jakob, "Mitsuba 0.6
//   Documentation".
#pragma once

#include <string>

#include "import/image_use.h"
#include "scene/scene.h"

namespace troffer {

// The scene such a file describes, in its own world; emission in W/(m² sr) as the file has it.
// Files it names are looked up in its folder and never outside. Shapes, bsdfs, textures, emitters
// and sensors that are not supported are warnings that name them; docs/mitsuba.md lists all.
// Sources are called by their id, else emitter0, emitter1 … in the order of the shapes that emit.
// The front of a surface, which alone emits, is the side of its normals, else of its winding;
// flip_normals turns it.
// InputError: with line and column, for anything malformed.
Scene import_mitsuba(const std::string& path, ImageUse images = ImageUse::read);

}  // namespace troffer
