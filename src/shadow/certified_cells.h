// A flat source cut into cells for a cluster of receivers: the bintree over the source, grown by
// geometry alone.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/vec.h"
#include "light/light_primitive.h"
#include "light/source_surface.h"
#include "shadow/coverage_mask.h"
#include "shadow/shadow_scene.h"
#include "shadow/shaft.h"

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

// A convex part of a source, inside a parallelogram of its own.
struct CertifiedCell {
  Parallelogram plane;
  std::array<Vec2, most_source_corners> outline;   // in (u,v) of `plane`
  int count = 0;                                   // 0: all of the parallelogram
  std::array<Vec3d, most_source_corners> corners;  // in space
  int corner_count = 0;

  std::span<const Vec2> all_outline() const { return {outline.data(), size_t(count)}; }
  std::span<const Vec3d> all_corners() const { return {corners.data(), size_t(corner_count)}; }
};

// A cell is halved while, for some corner of the receivers' hull, the unoccluded term's largest
// value over it exceeds its mean by more than the factor `variation`, and the cell gives more than
// `least_share` of all that the source gives; or while it gives more than `most_share`.
struct CellLimits {
  double variation = 3;
  double least_share = 0.02;
  double most_share = 1;
  size_t most_cells = 128;
};

// The part of the source above the horizon of flat receivers (all of it for others), as one cell;
// count of corners 0 where nothing is.
CertifiedCell visible_part(const FlatSource& source, const ReceiverHull& hull);

// Halves `cell` along its longer side. False where a half would have no area.
bool halve(const CertifiedCell& cell, CertifiedCell& first, CertifiedCell& second);

// Appends the leaves of the bintree over `cell`. A disk stays whole.
void cut_cells(const CertifiedCell& cell, const ReceiverHull& hull, const CellLimits& limits,
               std::vector<CertifiedCell>& out);

}  // namespace troffer
