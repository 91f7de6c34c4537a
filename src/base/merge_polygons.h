// Merges coplanar convex polygons of one surface, so that a tessellated wall becomes one polygon.
// The result is exact to the rounding of single-precision coordinates. Used for occluders, sources
// and mirrors.
//
// Polygons merge across a whole edge that only they share and that they traverse in opposite
// directions. Merged polygons are convex unions of whole pieces. Let L be the largest absolute
// coordinate of a connected flat region. All its vertices lie in a slab of thickness 2^-21 L. An
// omitted vertex lies within 2^-22 L of the merged polygon's edge, and within 2^-10 of the
// polygon's width. A merged polygon therefore covers what its pieces cover up to 2^-21 L, about the
// rounding error of the vertices. A neighbour may keep an omitted vertex; the gap is no larger than
// that, so a ray that starts a rounding error off its surface does not notice. Edges without
// omitted vertices keep their exact numbers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/polygon_list.h"
#include "base/vec.h"

namespace troffer {

constexpr uint32_t no_polygon = 0xffffffffu;

struct MergedPolygons {
  PolygonList polygons;  // corners in the order of the pieces, so the front stays the front
  // index of the covering polygon, by piece; no_polygon if it has no area
  std::vector<uint32_t> of_piece;
};

// pieces: convex polygons of at most 12 corners, which are indices of welded positions; edges:
// sorted_edges(pieces). Merged polygons have at most most_corners corners (at most 12). A piece
// that cannot be merged is kept. Polygons are numbered by connected flat regions, in the order of
// their first pieces. Deterministic; O(n log n) for typical tessellations.
MergedPolygons merge_polygons(std::span<const Vec3> positions, const PolygonList& pieces,
                              std::span<const PolygonEdge> edges, size_t most_corners);
// The same, with edges made on demand (for_each_edge) and passed on to `look`.
MergedPolygons merge_polygons(std::span<const Vec3> positions, const PolygonList& pieces,
                              size_t most_corners, const EdgeVisitor& look);

}  // namespace troffer
