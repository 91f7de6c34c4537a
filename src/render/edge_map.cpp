#include "render/edge_map.h"

#include "base/ablation.h"
#include "render/pixel_corners.h"
#include "render/sub_pixel_features.h"

namespace troffer {

EdgeMap::EdgeMap(const PreparedScene& scene, const ViewingCamera& camera, const PixelRect& region,
                 const LightOutlines& outlines, int threads)
    : region_(region), edges_(size_t(region.width()) * size_t(region.height()), 0) {
  const PixelCorners corners(scene, camera, region, threads);
  for (int y = region.y0; y < region.y1; ++y)
    for (int x = region.x0; x < region.x1; ++x)
      if (corners.differ(x, y)) edges_[index(x, y)] = surface_edge;
  const std::vector<uint8_t> has_thing =
      pixels_with_sub_pixel_features(scene, camera, region, corners, edges_, threads);
  for (size_t i = 0; i < edges_.size(); ++i)
    if (has_thing[i] != 0 && !is_left_out<"sub-pixel features">()) edges_[i] |= sub_pixel_feature;
  for (int y = region.y0; y < region.y1; ++y)
    for (int x = region.x0; x < region.x1; ++x)
      if (outlines.has_outline(x, y) && !is_left_out<"light outlines">())
        edges_[index(x, y)] |=
            outlines.is_known(x, y) && !outlines.is_doubtful(x, y) ? known_light_edge : light_edge;
}

}  // namespace troffer
