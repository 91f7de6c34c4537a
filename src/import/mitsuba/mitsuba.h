// Importer of Mitsuba scenes (.xml), versions 0.5 to 3. Called by import_scene (import/import.h).
// Lengths stay in the units of the file; emission is radiance in W/(m² sr).
//
// References: [1] W. Jakob et al., "Mitsuba 3 documentation"; [2] W. Jakob, "Mitsuba 0.6
//   Documentation".
#pragma once

#include <string>

#include "import/image_use.h"
#include "scene/scene.h"

namespace troffer {

// Returns the scene that the file describes, in its own world. Files that it names are looked up in
// its folder and never outside. Every unsupported shape, bsdf, texture, emitter or sensor adds a
// warning; docs/reference/mitsuba.md lists them. Lights are named by their id, otherwise emitter0,
// emitter1 and so on in the order of the emitting shapes. A surface emits from its front only: the
// side of its normals, or of its winding without normals. flip_normals swaps the sides. Throws
// InputError, with line and column, for malformed files.
Scene import_mitsuba(const std::string& path, ImageUse images = ImageUse::read);

}  // namespace troffer
