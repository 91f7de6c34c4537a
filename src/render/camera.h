// Viewing rays of a camera that is fitted to an image size, and cameras for scenes that have none.
// Used for pictures, previews, and wherever a point must be found in the picture. Raster positions
// are in pixels from the top left corner; lengths are in metres.
#pragma once

#include "base/vec.h"
#include "scene/scene.h"
#include "trace/ray.h"

namespace troffer {

class ViewingCamera {
 public:
  // width, height: size of the whole image in pixels, even if only a crop of it is rendered.
  ViewingCamera(const Camera& camera, int width, int height);

  // Returns the ray through a raster position, with unit direction. lens in [0,1]² chooses the
  // point on the lens.
  Ray ray(const Vec2& raster, const Vec2& lens) const;
  // Inverse of ray(): the raster position where a point is seen through the middle of the lens.
  // Returns false if the point is not in front of the camera, and for fisheyes.
  bool raster_of(const Vec3& p, Vec2& raster) const;
  // Returns the footprint of one of `rays` rays of a pixel: 1 / √rays of the pixel's width, at
  // least an eighth. The mean of the rays is then blurred by no more than a pixel.
  RayCone cone(int rays) const;
  int longer_side() const { return longer_side_; }  // pixels
  bool has_lens() const { return camera_.lens_radius > 0; }
  // True if all rays start at one point.
  bool is_perspective() const { return camera_.kind != CameraKind::orthographic; }
  // Returns the unit vector from a point to the eye.
  Vec3 towards_eye(const Vec3& p) const {
    return is_perspective() ? normalize(camera_.position - p) : -camera_.forward;
  }
  // Distance from the camera's position, metres.
  float distance(const Vec3& p) const { return length(p - camera_.position); }
  // Distance along the viewing axis, metres.
  float depth(const Vec3& p) const { return dot(p - camera_.position, camera_.forward); }

 private:
  Camera camera_;
  // Image plane coordinates (at distance 1 for perspective) of raster (0,0), and their step per
  // pixel.
  Vec2 corner_, step_;
  int longer_side_;
};

// Returns the image size of a camera. The size asked for comes first, then the file's, then 768
// lines at the camera's aspect ratio (default 4:3). A side of 0 was not asked for; it follows from
// the other side and the proportions.
struct ImageSize {
  int width, height;
};
ImageSize image_size(const Camera& camera, int asked_width, int asked_height);

// Returns a camera for a scene whose file has none: near a corner of the bounds at eye height,
// looking across, as one photographs a room. The scene's vertical axis is the one nearest to
// `up_hint`.
Camera default_camera(const Scene& scene, const Vec3& up_hint);

// Returns a camera that looks from eye to target. `fov_deg` is the field of view over the shorter
// image axis.
Camera look_at(const Vec3& eye, const Vec3& target, const Vec3& up, float fov_deg);

}  // namespace troffer
