// Wavefront OBJ files with their MTL material libraries.
//
// References: [1] Wavefront Technologies, "Advanced Visualizer Manual", Appendix B1 (object files)
//   and "MTL material format", 1995.
#pragma once

#include <string>

#include "import/image_use.h"
#include "import/read_progress.h"
#include "scene/scene.h"

namespace troffer {

// The scene an .obj file describes: one mesh per object, group and material; the front of a face
// is the side from which its vertices run counterclockwise. A material with Ke emits from the
// front, in W/(m² sr); its meshes are called emitter0, emitter1 … in order of appearance. No
// cameras. Free-form curves, points, lines and smoothing groups are left out.
// Material libraries and images are looked up beside the file that names them and never outside
// the scene's folder; a missing one is a warning. mtl_convert.h says how materials are read.
// InputError: with line and column, for malformed numbers and indices out of range.
Scene import_obj(const std::string& path, const PieceReading& how = {},
                 ImageUse images = ImageUse::read);

}  // namespace troffer
