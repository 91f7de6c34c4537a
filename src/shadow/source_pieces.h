// A light's flat pieces as few convex flat sources: what tessellation has cut is put together
// again, so that a rectangle of 10 000 triangles is one source (base/merge_polygons.h).
#pragma once

#include <cstdint>
#include <vector>

#include "light/light_primitive.h"
#include "shadow/shadow_source.h"

namespace troffer {

struct SourcePiece {
  FlatSource shape;                  // its front
  std::vector<uint32_t> primitives;  // what it covers, ascending; a polygon with too many corners
                                     // is covered by several pieces
};

// Sets `out` to sources that together cover what the light's pieces cover, each once, to the
// rounding of the pieces' vertices. False, with `out` empty, where a piece is a sphere or textured:
// such a light is not flat, or not of one radiance. Polygons merge where they share an edge
// between exactly equal vertices. Deterministic; O(n log n).
bool merge_sources(const LightPrimitives& primitives, uint32_t light,
                   std::vector<SourcePiece>& out);

}  // namespace troffer
