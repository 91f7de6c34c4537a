// Search for sub-pixel features: things between the corners of pixels, such as distant leaves,
// wires, or slats seen edge-on. They are found from their geometry, without random samples. Used by
// EdgeMap.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/pixel_corners.h"

namespace troffer {

// Returns per pixel of the region, row by row, whether it shows such a feature: a triangle, sphere
// or disk narrower than about 1.5 pixels, not on a surface that the pixel's corners see. has_edge:
// pixels whose corners differ, in the same order; they are skipped. Triangles that reach behind the
// camera are left out.
std::vector<uint8_t> pixels_with_sub_pixel_features(const PreparedScene& scene,
                                                    const ViewingCamera& camera,
                                                    const PixelRect& region,
                                                    const PixelCorners& corners,
                                                    std::span<const uint8_t> has_edge, int threads);

}  // namespace troffer
