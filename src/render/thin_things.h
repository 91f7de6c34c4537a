// Things that lie between the corners of pixels: leaves far away, wires, slats seen from their
// edges. They are found by where their triangles are, not by chance.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/pixel_corners.h"

namespace troffer {

// Per pixel of the region, row by row: whether a triangle, sphere or disk that is narrower than a
// pixel or two is seen in it, through its middle, and is none of what the pixel's corners see.
// has_edge: likewise, of pixels whose corners differ; they are not looked at. Triangles that reach
// behind the camera are left out.
std::vector<uint8_t> pixels_with_thin_things(const PreparedScene& scene,
                                             const ViewingCamera& camera, const PixelRect& region,
                                             const PixelCorners& corners,
                                             std::span<const uint8_t> has_edge, int threads);

}  // namespace troffer
