// Surfaces seen through the corners of pixels, one ray per corner. EdgeMap and the search for
// sub-pixel features compare them. Positions are in world space, metres.
#pragma once

#include <cstddef>
#include <vector>

#include "render/camera.h"
#include "render/tile.h"
#include "transport/prepared_scene.h"

namespace troffer {

// A visible surface point.
struct SeenPlace {
  uint32_t geometry = no_geometry;
  bool is_front = true;
  Vec3 normal, position;  // shading normal, on the viewer's side

  // True if both are on the same object, with normals within 25 degrees (like is_same_surface of
  // shadow_record.h) and no step in depth between them.
  bool is_of_surface_of(const SeenPlace& other) const;
};

class PixelCorners {
 public:
  PixelCorners(const PreparedScene& scene, const ViewingCamera& camera, const PixelRect& region,
               int threads);

  // Returns the upper left corner of a pixel of the region.
  const SeenPlace& of(int x, int y) const { return corners_[index(x, y)]; }
  // True if the corners of the pixel see more than one surface.
  bool differ(int x, int y) const;

 private:
  size_t index(int x, int y) const {
    return size_t(y - region_.y0) * columns_ + size_t(x - region_.x0);
  }

  PixelRect region_;
  size_t columns_;
  std::vector<SeenPlace> corners_;
};

}  // namespace troffer
