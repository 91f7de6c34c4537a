// Which triangles close something off: sets of them without an open edge.
//
// A set in which every piece of every edge belongs to an even number of triangles divides space
// into an inside and an outside, whichever way they are wound: a way that crosses an odd number of
// them leads from one to the other.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"

namespace troffer {

// Triangles of welded vertices (base/polygon_list.h). Returns sets of them that hang together by
// edges and have no open one; what has open edges is left out, triangle by triangle, until nothing
// is open. Edges along an axis may end at each other's inner points, where these lie on them
// exactly. Deterministic; about O(n log n).
std::vector<std::vector<uint32_t>> closed_surfaces(
    std::span<const Vec3> positions, std::span<const std::array<uint32_t, 3>> triangles);

}  // namespace troffer
