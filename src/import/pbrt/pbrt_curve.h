// pbrt's curves as tubes and ribbons of triangles.
// References: [1] pbrt-v4 Input File Format, section "Shapes", pbrt.org/fileformat-v4.
#pragma once

#include "import/pbrt/pbrt_params.h"
#include "import/recentre.h"

namespace troffer {

// Bézier or B-spline of degree 2 or 3. "cylinder" and "flat" (which turns to the viewer) become
// tubes whose mean width from all sides is the curve's; "ribbon" a strip on the side of its
// normals; (u,v) run across and along. InputError where the numbers of points or normals fit no
// curve, or there are more than `max_triangles`.
AnchoredMesh read_pbrt_curve(const PbrtParams& params, size_t max_triangles, WarningLog& warnings);

}  // namespace troffer
