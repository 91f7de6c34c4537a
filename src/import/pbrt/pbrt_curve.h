// Converts pbrt's curves to tubes and ribbons of triangles in object space. Used by
// read_pbrt_shape.
//
// References: [1] pbrt-v4 Input File Format, section "Shapes", pbrt.org/fileformat-v4.
#pragma once

#include "import/pbrt/pbrt_params.h"
#include "import/recentre.h"

namespace troffer {

// Reads a Bézier or B-spline curve of degree 2 or 3. "cylinder" and "flat" (which turns to the
// viewer) become tubes; their mean width over all directions is the width of the curve. "ribbon"
// becomes a strip that faces along its normals. u runs across the curve and v along it. Throws
// InputError if the number of points or normals fits no curve, or if there would be more than
// `max_triangles`.
AnchoredMesh read_pbrt_curve(const PbrtParams& params, size_t max_triangles, WarningLog& warnings);

}  // namespace troffer
