// Importer of pbrt-v4 scene files (.pbrt). Called by import_scene (import/import.h). Lengths stay
// in the units of the file; emission is radiance in W/(m² sr).
//
// References: [1] pbrt-v4 Input File Format, pbrt.org/fileformat-v4.
#pragma once

#include <string>

#include "import/image_use.h"
#include "scene/scene.h"

namespace troffer {

// Returns the scene that a .pbrt file describes, in the file's own (left-handed) world. Files that
// it names are looked up in its folder and never outside. Every unsupported shape, material,
// texture or light adds a warning that names it. Lights are named emitter0, emitter1, … in the
// order of the emitting shapes.
//
// A surface emits from its front, and from both sides if its light is twosided. The front is the
// side of pbrt's surface normal [1]. Per-vertex normals decide if a mesh has them. Otherwise the
// winding decides, or for quadrics the outside (disk: +z). ReverseOrientation swaps the sides. A
// mirroring transform swaps them too, unless there are per-vertex normals.
//
// Throws InputError, with line and column, for malformed files.
Scene import_pbrt(const std::string& path, ImageUse images = ImageUse::read);

}  // namespace troffer
