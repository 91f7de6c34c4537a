// Loop subdivision surfaces, for pbrt's `loopsubdiv`.
// References: [1] C. Loop, "Smooth Subdivision Surfaces Based on Triangles", MSc thesis, University
//   of Utah, 1987; [2] H. Hoppe et al., "Piecewise Smooth Surface Reconstruction", SIGGRAPH 1994
//   (boundaries as creases, limit positions).
#pragma once

#include "scene/scene.h"

namespace troffer {

// Subdivides the control mesh `levels` times and moves its vertices to their limit positions.
// Normals are those of the resulting triangles, smoothed. Boundaries are curves of their own.
// Vertices stay where more than two triangles share an edge or a boundary branches.
// Uses only the positions and triangles of `control`; its indices must be in range.
Mesh subdivide_loop(const Mesh& control, int levels);

}  // namespace troffer
