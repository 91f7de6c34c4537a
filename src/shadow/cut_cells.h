// Divides a flat source into source cells over which its light varies little, for one cluster. The
// cells are the leaves of a bintree over the source that depends on geometry alone. settle_part.h
// and direct_rays.h use them. Lengths in metres.
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

// A convex part of a source, with the parallelogram that bounds it.
struct FlatCell {
  Parallelogram plane;
  std::array<Vec2, most_source_corners> outline;  // in (u,v) of `plane`
  int count = 0;  // corners of `outline`; 0: all of the parallelogram
  std::array<Vec3d, most_source_corners> corners;  // in world space
  int corner_count = 0;
  bool is_disk = false;  // the whole disk inscribed in the parallelogram

  std::span<const Vec2> all_outline() const { return {outline.data(), size_t(count)}; }
  std::span<const Vec3d> all_corners() const { return {corners.data(), size_t(corner_count)}; }
};

// Limits of the bintree. A cell is halved while it gives more than `most_share` of the source's
// light. It is also halved while it gives more than `least_share` and, for some corner of the hull,
// the largest unoccluded term over it exceeds `variation` times the mean. Shares are exact form
// factors, so there are at most about 9 / least_share cells.
struct CellLimits {
  double variation = 3;
  double least_share = 0.02;
  double most_share = 1;
};

// Returns the part of the source above the horizon of flat receivers (all of it for others) as one
// cell. The cell has no corners if nothing is above the horizon.
FlatCell visible_part(const FlatSource& source, const ReceiverHull& hull);

// Halves `cell` across its longer side. Returns false if a half would have no area.
bool halve(const FlatCell& cell, FlatCell& first, FlatCell& second);

// Appends the leaves of the bintree over `cell`. A disk that has to be split becomes four quarters
// first: polygons whose arcs are chords and whose areas are exact.
void cut_cells(const FlatCell& cell, const ReceiverHull& hull, const CellLimits& limits,
               std::vector<FlatCell>& out);

}  // namespace troffer
