// Merges the flat pieces of a light into few convex flat sources, so that a tessellated rectangle
// of 10 000 triangles is one source (base/merge_polygons.h).
#pragma once

#include <cstdint>
#include <vector>

#include "light/light_primitive.h"
#include "shadow/shadow_source.h"

namespace troffer {

// A flat source and the pieces of a light that it covers.
struct SourcePiece {
  FlatSource shape;  // its front
  // Indices of the covered pieces, ascending. A polygon with too many corners is covered by several
  // sources.
  std::vector<uint32_t> primitives;
};

// Sets `out` to sources that cover each piece of the light once, to the rounding of the pieces'
// vertices. Polygons merge where they share an edge between exactly equal vertices. Returns false,
// with `out` empty, if a piece is a sphere or textured: the light is then not flat, or not uniform.
// Deterministic; O(n log n).
bool merge_sources(const LightPrimitives& primitives, uint32_t light,
                   std::vector<SourcePiece>& out);

}  // namespace troffer
