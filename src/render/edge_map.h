// Edges within pixels, found by geometry and not by the picture's own samples. Refinement that
// depends on them therefore leaves the mean of every pixel unbiased. Rendering makes one after the
// first pass.
#pragma once

#include <cstdint>
#include <vector>

#include "render/camera.h"
#include "render/light_outlines.h"
#include "render/tile.h"
#include "transport/prepared_scene.h"

namespace troffer {

class EdgeMap {
 public:
  // Traces one ray through each corner of a pixel, looks for sub-pixel features between the
  // corners, and adds the light outlines of the same region.
  EdgeMap(const PreparedScene& scene, const ViewingCamera& camera, const PixelRect& region,
          const LightOutlines& outlines, int threads);

  // True if the corners of the pixel see different surfaces, or if it shows a sub-pixel feature.
  bool has_surface_edge(int x, int y) const {
    return (edges_[index(x, y)] & (surface_edge | sub_pixel_feature)) != 0;
  }
  // True if the pixel shows a sub-pixel feature, whose coverage is unknown.
  bool has_sub_pixel_feature(int x, int y) const {
    return (edges_[index(x, y)] & sub_pixel_feature) != 0;
  }
  // True if a light outline passes through the pixel.
  bool has_light_edge(int x, int y) const {
    return (edges_[index(x, y)] & (light_edge | known_light_edge)) != 0;
  }
  // True if one does, and the light's coverage is unknown (LightOutlines::is_known).
  bool has_unknown_light_edge(int x, int y) const {
    return (edges_[index(x, y)] & light_edge) != 0;
  }

 private:
  static constexpr uint8_t surface_edge = 1, light_edge = 2, sub_pixel_feature = 4,
                           known_light_edge = 8;
  size_t index(int x, int y) const {
    return size_t(y - region_.y0) * size_t(region_.width()) + size_t(x - region_.x0);
  }

  PixelRect region_;
  std::vector<uint8_t> edges_;
};

}  // namespace troffer
