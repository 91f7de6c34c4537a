// Importer of Radiance scenes (.rad). Called by import_scene (import/import.h). Emission is
// radiance in W/(m² sr), at Radiance's 179 lm/W.
//
// References: [1] "The RADIANCE 5.1 Synthetic Imaging System" (reference manual); [2] Radiance
//   manual pages xform(1), genbox(1).
#pragma once

#include <string>

#include "scene/scene.h"

namespace troffer {

// Returns the scene of the file and of the files that its !xform and !cat include. Files are looked
// up in its folder and never outside. No command is ever run. Cameras come from comments with view
// options, otherwise from NAME.vf next to NAME.rad. Lights are named by their identifiers.
// docs/reference/radiance.md lists what is supported, approximated, left out and refused. Throws
// InputError, with line and column, for malformed files.
Scene import_radiance(const std::string& path);

}  // namespace troffer
