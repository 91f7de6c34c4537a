// The PLY polygon format: ascii and both binary byte orders.
//
// References: [1] G. Turk, "The PLY Polygon File Format", 1994.
#pragma once

#include <string>

#include "base/log.h"
#include "import/read_progress.h"
#include "import/recentre.h"

namespace troffer {

struct PlyLimits {
  size_t max_triangles = 200'000'000;
  PieceReading pieces = {};
};

// The triangles of a PLY file as they stand (not cleaned: vertices may be NaN, triangles without
// area). Elements and properties come in any order and of any scalar type: vertex x y z, nx ny nz,
// and u v, s t, texture_u texture_v or texture_s texture_t; face vertex_indices or vertex_index of
// an integer type, polygons cut into fans. Other elements are skipped with a warning, other
// properties silently.
// InputError: malformed or truncated files (line and column of the header or of an ascii body, 0
// in a binary body), no x y z, indices out of range, more than max_triangles triangles.
// Memory stays in proportion to the size of the file whatever its counts say.
AnchoredMesh read_ply(const std::string& path, WarningLog& warnings, const PlyLimits& limits = {});

}  // namespace troffer
