// Shapes of sources in certified visibility: convex and flat, or a sphere. Lengths in metres.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "light/light_primitive.h"
#include "light/source_surface.h"
#include "shadow/coverage_mask.h"
#include "shadow/shadow_scene.h"

namespace troffer {

// Most corners of a source's outline. A horizon adds one corner, and halvings, which clip to a
// rectangle, add four.
constexpr size_t most_outline_corners = most_source_corners - 5;

// A flat source: a convex part of a parallelogram. outline: its corners in (u,v), at most
// most_outline_corners; empty: all of the parallelogram. The normal points to the receivers that
// count. is_disk: the part is the inscribed disk, and the parallelogram is a square.
struct FlatSource {
  Parallelogram plane;
  std::vector<Vec2> outline;
  bool is_disk = false;

  std::vector<Vec3d> corners() const;  // in world space; for disks, of the square
};

// Sets `out` to a piece of a light; is_back: its back. Returns false for spheres and for polygons
// with more than most_outline_corners corners.
bool make_flat_source(const LightPrimitive& piece, bool is_back, FlatSource& out);
// Sets `out` to a convex polygon whose corners run counterclockwise seen from its front. A
// parallelogram becomes itself, a triangle half of one, and any other polygon a part of the
// smallest rectangle along a side. Returns false if it has no area or too many corners.
bool make_flat_source(std::span<const Vec3> polygon, FlatSource& out);

// A sphere that emits outwards. own: the scene's number for it, so that it does not hide itself.
struct SphereSource {
  Vec3d centre;
  double radius = 0;
  uint64_t own = no_round_source;
};

}  // namespace troffer
