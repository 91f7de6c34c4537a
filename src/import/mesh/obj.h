// Importer of Wavefront OBJ files with their MTL material libraries. Positions keep the file's
// units; emission is in W/(m² sr). docs/reference/formats.md lists the statements.
//
// References: [1] Wavefront Technologies, "Advanced Visualizer Manual", Appendix B1 (object files)
//   and "MTL material format", 1995.
#pragma once

#include <string>

#include "import/image_use.h"
#include "import/read_progress.h"
#include "scene/scene.h"

namespace troffer {

// Imports an .obj file: one mesh per object, group and material. The front of a face is the side
// from which its vertices run counterclockwise. Materials with Ke emit from the front; their lights
// are named emitter0, emitter1, … in order of appearance.
// There are no cameras. Free-form curves, points, lines and smoothing groups are left out.
// Material libraries and images are searched beside the file that names them, never outside the
// scene's folder; a missing one gives a warning. mtl_convert.h describes the materials.
// Throws InputError with line and column for malformed numbers and for indices out of range.
Scene import_obj(const std::string& path, const PieceReading& how = {},
                 ImageUse images = ImageUse::read);

}  // namespace troffer
