// Sources as certified visibility takes them: flat and convex, or a sphere.
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

// Corners of a source's outline, at most: a horizon that cuts it adds one, and halvings, which cut
// it by a rectangle, add four.
constexpr size_t most_outline_corners = most_source_corners - 5;

// A flat source: the part `outline` (corners in (u,v), convex, at most most_outline_corners; empty:
// all) of a parallelogram whose normal points to the receivers that count. is_disk: the disk
// inscribed in it, which must then be a square.
struct FlatSource {
  Parallelogram plane;
  std::vector<Vec2> outline;
  bool is_disk = false;

  std::vector<Vec3d> corners() const;  // in space; of a disk's square
};

// A piece of a light as a flat source; `is_back`: seen from behind. False for spheres and for
// polygons of more than most_outline_corners corners, which are none.
bool make_flat_source(const LightPrimitive& piece, bool is_back, FlatSource& out);
// A convex polygon, counterclockwise seen from its front: itself if it is a parallelogram, else a
// part of the smallest rectangle along a side (of a triangle: along two sides). False if it has no
// area, or too many corners.
bool make_flat_source(std::span<const Vec3> polygon, FlatSource& out);

// A sphere that shines outwards. `own`: what the scene calls it, so that it does not hide itself.
struct SphereSource {
  Vec3d centre;
  double radius = 0;
  uint64_t own = no_round_source;
};

}  // namespace troffer
