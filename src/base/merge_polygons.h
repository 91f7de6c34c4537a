// Coplanar convex polygons of one surface merged to larger ones, so that a tessellated wall is one
// polygon: exact to the rounding of single-precision coordinates.
//
// Polygons merge across a whole edge that only they share, along which they run in opposite
// directions; merged ones are convex, and unions of whole pieces. Let L be the largest absolute
// coordinate of a connected flat region. All its vertices lie within a slab 2^-21 L thick. A vertex
// that is left out lies within 2^-22 L of the merged polygon's edge, and within 2^-10 of that
// polygon's width. So a merged polygon covers what its pieces cover and no more, up to 2^-21 L, of
// the order of what rounding to single precision moved the vertices by. Where neighbours keep a
// vertex that it leaves out, the two part by no more than that: no ray that starts a rounding error
// off its surface can tell. An edge that nothing is left out of stays the same numbers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/polygon_list.h"
#include "base/vec.h"

namespace troffer {

constexpr uint32_t no_polygon = 0xffffffffu;

struct MergedPolygons {
  PolygonList polygons;  // corners in the order of the pieces' (the front stays the front)
  std::vector<uint32_t> of_piece;  // per piece: what covers it; no_polygon where it has no area
};

// pieces: convex polygons of at most 12 corners, which are indices of welded positions; edges:
// sorted_edges(pieces). Merged polygons have at most most_corners corners (at most 12); a piece
// that merges with nothing stays as it is. Polygons are numbered by their connected flat regions,
// in order of the first pieces. Deterministic; O(n log n) for what tessellation makes.
MergedPolygons merge_polygons(std::span<const Vec3> positions, const PolygonList& pieces,
                              std::span<const PolygonEdge> edges, size_t most_corners);
// The same, with edges that are made as they are needed (for_each_edge), and handed on to `look`.
MergedPolygons merge_polygons(std::span<const Vec3> positions, const PolygonList& pieces,
                              size_t most_corners, const EdgeVisitor& look);

}  // namespace troffer
