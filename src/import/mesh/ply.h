// Reader of the PLY polygon format: ascii and both binary byte orders. Used for .ply scenes
// (ply_scene.h) and for meshes that pbrt and Mitsuba scenes name.
//
// References: [1] G. Turk, "The PLY Polygon File Format", 1994.
#pragma once

#include <string>

#include "base/log.h"
#include "import/read_progress.h"
#include "import/recentre.h"

namespace troffer {

// Limits and parameters of reading a PLY file.
struct PlyLimits {
  size_t max_triangles = 200'000'000;
  PieceReading pieces = {};
};

// Reads the triangles of a PLY file as stored: vertices may be NaN, and triangles may have no area.
// Elements and properties may come in any order and of any scalar type.
// Vertices have x y z, nx ny nz, and u v, s t, texture_u texture_v or texture_s texture_t. Faces
// have vertex_indices or vertex_index of an integer type; polygons become fans. Other elements are
// skipped with a warning, other properties silently.
// Throws InputError for malformed or truncated files, missing x y z, indices out of range, and more
// than max_triangles triangles. Line and column are those of the header or an ascii body, and 0 in
// a binary body.
// Memory stays in proportion to the size of the file, whatever its counts claim.
AnchoredMesh read_ply(const std::string& path, WarningLog& warnings, const PlyLimits& limits = {});

}  // namespace troffer
