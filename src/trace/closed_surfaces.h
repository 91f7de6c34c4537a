// Finds closed surfaces: sets of triangles without an open edge. If every piece of every edge
// belongs to an even number of triangles, the set divides space into inside and outside, whatever
// the winding. A path that crosses the set an odd number of times leads from one to the other.
// closed_shells.h uses it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"

namespace troffer {

// Returns sets of triangles that are connected by edges and have no open edge. Vertices must be
// welded (base/polygon_list.h). Triangles with open edges are removed one by one until no edge is
// open. Edges along an axis may end at inner points of each other, if these lie on them exactly.
// Deterministic; about O(n log n).
std::vector<std::vector<uint32_t>> closed_surfaces(
    std::span<const Vec3> positions, std::span<const std::array<uint32_t, 3>> triangles);

}  // namespace troffer
