// Radiance scenes (.rad).
//
// References: [1] "The RADIANCE 5.1 Synthetic Imaging System" (reference manual); [2] Radiance
// manual
//   pages xform(1), genbox(1).
#pragma once

#include <string>

#include "scene/scene.h"

namespace troffer {

// The scene such a file describes, with the files that its !xform and !cat name, which are looked
// up in its folder and never outside; no command is ever run. Emission in W/(m² sr), 179 lm/W, as
// Radiance has it. Cameras come of comments with view options, else of NAME.vf beside NAME.rad.
// Sources are called by their identifiers. docs/radiance.md lists what is done, approximated, left
// out and refused.
// InputError: with line and column, for anything malformed.
Scene import_radiance(const std::string& path);

}  // namespace troffer
