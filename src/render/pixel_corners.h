// What rays through the corners of pixels meet.
#pragma once

#include <cstddef>
#include <vector>

#include "render/camera.h"
#include "render/tile.h"
#include "transport/prepared_scene.h"

namespace troffer {

// A place that is seen.
struct SeenPlace {
  uint32_t geometry = no_geometry;
  bool is_front = true;
  Vec3 normal, position;  // the normal as shaded, on the viewer's side

  // The same object, facing about the same way (within 25 degrees, as is_same_surface of
  // shadow_record.h), and no step from one to the other.
  bool is_of_surface_of(const SeenPlace& other) const;
};

class PixelCorners {
 public:
  PixelCorners(const PreparedScene& scene, const ViewingCamera& camera, const PixelRect& region,
               int threads);

  // Of a pixel of the region: the upper left one.
  const SeenPlace& of(int x, int y) const { return corners_[index(x, y)]; }
  // They see more than one surface.
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
