// Bright regions of a fisheye picture: pixels above a threshold, joined if they are close, with
// very bright parts apart. Used by daylight_glare().
#pragma once

#include <cstddef>
#include <vector>

#include "base/vec.h"
#include "image/image.h"

namespace troffer {

// Directions and solid angles of the pixels of a square fisheye picture of 180°.
struct FisheyeGrid {
  int side = 0;

  // Direction at a position in pixels; whole numbers are the middles of pixels. z is the line of
  // sight, y up, x to the right.
  Vec3d direction(double x, double y) const;
  double solid_angle(int x, int y) const;  // sr; 0 beyond 90°
};

using GlareRegion = std::vector<size_t>;  // pixels, y × side + x, ascending

// Returns the regions of the pixels above `threshold`. Two pixels belong to one region if a chain
// of such pixels joins them, each at most `link_rad` from the next. If peak > 0, the pixels of a
// region at or above `peak` are split off into regions of their own, joined in the same way.
// Regions are in the order of their first pixels; those that were split off follow what remains.
std::vector<GlareRegion> glare_regions(const FisheyeGrid& grid, const Image& picture,
                                       double threshold, double peak, double link_rad);

}  // namespace troffer
