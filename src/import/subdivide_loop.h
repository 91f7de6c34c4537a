// Loop's subdivision surfaces.
// References: [1] C. Loop, "Smooth Subdivision Surfaces Based on Triangles", MSc thesis, University
//   of Utah, 1987; [2] H. Hoppe et al., "Piecewise Smooth Surface Reconstruction", SIGGRAPH 1994
//   (boundaries as creases, limit positions).
#pragma once

#include "scene/scene.h"

namespace troffer {

// The control mesh cut `levels` times into four triangles each, its vertices moved to where they
// tend in the limit, with smooth normals. Boundaries are curves of their own; where more than two
// triangles share an edge, or a boundary branches, vertices stay. Only positions and triangles of
// `control` are looked at; its indices must be in range.
Mesh subdivide_loop(const Mesh& control, int levels);

}  // namespace troffer
