// Viewing rays from a camera.
#pragma once

#include "base/vec.h"
#include "scene/scene.h"
#include "trace/ray.h"

namespace troffer {

// A camera fitted to an image size.
class ViewingCamera {
 public:
  // width, height: the whole image in pixels, also where only a crop of it is rendered.
  ViewingCamera(const Camera& camera, int width, int height);

  // The ray through raster position (x, y), in pixels from the top left corner, whose direction is
  // unit. lens in [0,1]² picks the point on the lens.
  Ray ray(const Vec2& raster, const Vec2& lens) const;
  // Where a point is seen through the middle of the lens: the inverse of ray(). False where it is
  // not before the camera.
  bool raster_of(const Vec3& p, Vec2& raster) const;
  // What one of `rays` rays of a pixel stands for: between the root's share of its width and an
  // eighth, so that their mean is not blurred by more than the pixel.
  RayCone cone(int rays) const;
  int longer_side() const { return longer_side_; }  // of the image, pixels
  bool has_lens() const { return camera_.lens_radius > 0; }
  bool is_perspective() const { return camera_.kind == CameraKind::perspective; }
  // Unit, from a point to where it is seen from.
  Vec3 towards_eye(const Vec3& p) const {
    return is_perspective() ? normalize(camera_.position - p) : -camera_.forward;
  }
  // From the camera's position.
  float distance(const Vec3& p) const { return length(p - camera_.position); }
  // Distance of a point along the viewing axis, metres.
  float depth(const Vec3& p) const { return dot(p - camera_.position, camera_.forward); }

 private:
  Camera camera_;
  // Image plane coordinates (at distance 1 for perspective) of raster (0,0), and per pixel.
  Vec2 corner_, step_;
  int longer_side_;
};

// Image size for a camera: what was asked for (0: not; of one side, the other by the proportions of
// what follows); else what the file says; else 768 lines at its aspect ratio (4:3 without one).
struct ImageSize {
  int width, height;
};
ImageSize image_size(const Camera& camera, int asked_width, int asked_height);

// A camera for a scene whose file has none: inside the bounds near a corner at eye height, looking
// across, as one would photograph a room. `up_hint` lies nearest to the axis the scene stands on.
Camera default_camera(const Scene& scene, const Vec3& up_hint);

// Looks from eye to target; fov in degrees over the shorter image axis.
Camera look_at(const Vec3& eye, const Vec3& target, const Vec3& up, float fov_deg);

}  // namespace troffer
