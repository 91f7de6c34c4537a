// A flat source cut into cells for a cluster of receivers: the bintree over the source, grown by
// geometry alone.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/vec.h"
#include "light/source_surface.h"
#include "shadow/coverage_mask.h"
#include "shadow/shadow_source.h"
#include "shadow/shaft.h"

namespace troffer {

// A convex part of a source, inside a parallelogram of its own.
struct FlatCell {
  Parallelogram plane;
  std::array<Vec2, most_source_corners> outline;   // in (u,v) of `plane`
  int count = 0;                                   // 0: all of the parallelogram
  std::array<Vec3d, most_source_corners> corners;  // in space
  int corner_count = 0;
  bool is_disk = false;  // the whole disk inscribed in the parallelogram, whose corners these are

  std::span<const Vec2> all_outline() const { return {outline.data(), size_t(count)}; }
  std::span<const Vec3d> all_corners() const { return {corners.data(), size_t(corner_count)}; }
};

// A cell is halved while, for some corner of the receivers' hull, the unoccluded term's largest
// value over it exceeds its mean by more than the factor `variation`, and the cell gives more than
// `least_share` of all that the source gives; or while it gives more than `most_share`. Shares are
// those of exact form factors, so that there are no more than about 9 / least_share cells.
struct CellLimits {
  double variation = 3;
  double least_share = 0.02;
  double most_share = 1;
};

// The part of the source above the horizon of flat receivers (all of it for others), as one cell;
// count of corners 0 where nothing is.
FlatCell visible_part(const FlatSource& source, const ReceiverHull& hull);

// Halves `cell` along its longer side. False where a half would have no area.
bool halve(const FlatCell& cell, FlatCell& first, FlatCell& second);

// Appends the leaves of the bintree over `cell`. A disk that does not stay whole is cut into
// quarters first: polygons whose arcs are strings of chords about them, with the arcs' areas.
void cut_cells(const FlatCell& cell, const ReceiverHull& hull, const CellLimits& limits,
               std::vector<FlatCell>& out);

}  // namespace troffer
