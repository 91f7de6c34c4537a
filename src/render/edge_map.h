// Where edges run through pixels, found without any of the samples that the picture is made of:
// refinement that goes by it keeps the mean of every pixel.
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
  // One ray through each corner of a pixel, things that lie between corners, and the outlines of
  // lights, of the same region.
  EdgeMap(const PreparedScene& scene, const ViewingCamera& camera, const PixelRect& region,
          const LightOutlines& outlines, int threads);

  // The corners of the pixel see different surfaces, or something is seen that is none of theirs.
  bool has_surface_edge(int x, int y) const {
    return (edges_[index(x, y)] & (surface_edge | thin_thing)) != 0;
  }
  // … the latter: how much of the pixel it covers is not known.
  bool has_thin_thing(int x, int y) const { return (edges_[index(x, y)] & thin_thing) != 0; }
  // The outline of a light goes through it.
  bool has_light_edge(int x, int y) const {
    return (edges_[index(x, y)] & (light_edge | known_light_edge)) != 0;
  }
  // … and how much of it the light covers is not known (LightOutlines::is_known).
  bool has_unknown_light_edge(int x, int y) const {
    return (edges_[index(x, y)] & light_edge) != 0;
  }

 private:
  static constexpr uint8_t surface_edge = 1, light_edge = 2, thin_thing = 4, known_light_edge = 8;
  size_t index(int x, int y) const {
    return size_t(y - region_.y0) * size_t(region_.width()) + size_t(x - region_.x0);
  }

  PixelRect region_;
  std::vector<uint8_t> edges_;
};

}  // namespace troffer
