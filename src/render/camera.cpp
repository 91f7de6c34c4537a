#include "render/camera.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/frame.h"
#include "base/warp.h"

namespace troffer {

ViewingCamera::ViewingCamera(const Camera& camera, int width, int height)
    : camera_(camera), longer_side_(std::max(width, height)) {
  const float aspect = float(width) / float(height);
  float x0, x1, y0, y1;  // image plane, x to the right, y up
  if (camera.has_screen_window) {
    x0 = camera.screen_window[0];
    x1 = camera.screen_window[1];
    y0 = camera.screen_window[2];
    y1 = camera.screen_window[3];
  } else if (camera.fov_is_vertical || aspect >= 1) {
    x0 = -aspect;
    x1 = aspect;
    y0 = -1;
    y1 = 1;
  } else {
    x0 = -1;
    x1 = 1;
    y0 = -1 / aspect;
    y1 = 1 / aspect;
  }
  corner_ = Vec2{x0, y1} * camera.half_extent;
  step_ = Vec2{(x1 - x0) / float(width), (y0 - y1) / float(height)} * camera.half_extent;
}

namespace {

// Returns the ray at angles x to the right and y up, in radians.
Ray fisheye_ray(const Camera& c, float x, float y) {
  const float r = std::sqrt(x * x + y * y), angle = std::min(r, pi_f);
  const float across = r > 0 ? std::sin(angle) / r : 1.0f;
  Ray ray;
  ray.origin = c.position;
  ray.direction = normalize(c.forward * std::cos(angle) + (c.right * x + c.up * y) * across);
  if (c.near_clip > 0) ray.t_min = c.near_clip;
  if (c.far_clip > 0) ray.t_max = c.far_clip;
  return ray;
}

}  // namespace

Ray ViewingCamera::ray(const Vec2& raster, const Vec2& lens) const {
  const float x = corner_.x + raster.x * step_.x, y = corner_.y + raster.y * step_.y;
  if (camera_.kind == CameraKind::fisheye) return fisheye_ray(camera_, x, y);
  const Vec3 across = camera_.right * x + camera_.up * y;
  const bool is_perspective = camera_.kind == CameraKind::perspective;
  Vec3 origin = is_perspective ? camera_.position : camera_.position + across;
  Vec3 direction = is_perspective ? camera_.forward + across : camera_.forward;
  if (camera_.lens_radius > 0) {
    const Vec3 focus = origin + direction * camera_.focal_distance;
    const Vec2 d = disk_from_square(lens) * camera_.lens_radius;
    origin = origin + camera_.right * d.x + camera_.up * d.y;
    direction = focus - origin;
  }
  Ray r;
  r.origin = origin;
  r.direction = normalize(direction);
  const float along = dot(r.direction, camera_.forward);
  if (camera_.near_clip > 0) r.t_min = camera_.near_clip / along;
  if (camera_.far_clip > 0) r.t_max = camera_.far_clip / along;
  return r;
}

RayCone ViewingCamera::cone(int rays) const {
  const float share = std::max(1 / std::sqrt(float(std::max(rays, 1))), 0.125f);
  const float width = share * std::sqrt(std::abs(step_.x * step_.y));
  return is_perspective() ? RayCone{0, width} : RayCone{width, 0};
}

bool ViewingCamera::raster_of(const Vec3& p, Vec2& raster) const {
  // Callers draw straight lines between raster positions, which a fisheye bends.
  if (camera_.kind == CameraKind::fisheye) return false;
  const Vec3 d = p - camera_.position;
  const float along = dot(d, camera_.forward);
  if (!(along > 1e-6f * length(d))) return false;
  const float scale = is_perspective() ? 1 / along : 1;
  const Vec2 on_plane = Vec2{dot(d, camera_.right), dot(d, camera_.up)} * scale;
  raster = {(on_plane.x - corner_.x) / step_.x, (on_plane.y - corner_.y) / step_.y};
  return true;
}

namespace {

ImageSize own_size(const Camera& camera) {
  if (camera.width > 0 && camera.height > 0) return {camera.width, camera.height};
  constexpr int lines = 768;
  const float aspect = camera.aspect > 0 ? std::clamp(camera.aspect, 0.1f, 10.0f) : 4.0f / 3.0f;
  return {std::max(1, int(std::lround(float(lines) * aspect))), lines};
}

// Returns a side of this length in pixels, times a ratio.
int other_side(int side, double ratio) {
  constexpr double largest = 1 << 20;  // larger pictures are refused later
  return int(std::lround(std::clamp(side * ratio, 1.0, largest)));
}

}  // namespace

ImageSize image_size(const Camera& camera, int asked_width, int asked_height) {
  if (asked_width > 0 && asked_height > 0) return {asked_width, asked_height};
  const ImageSize own = own_size(camera);
  if (asked_width > 0)
    return {asked_width, other_side(asked_width, double(own.height) / own.width)};
  if (asked_height > 0)
    return {other_side(asked_height, double(own.width) / own.height), asked_height};
  return own;
}

Camera look_at(const Vec3& eye, const Vec3& target, const Vec3& up, float fov_deg) {
  const Vec3 along = target - eye;
  if (!(length(along) > 0)) throw UsageError("the camera's eye and target are the same point");
  Camera c;
  c.position = eye;
  c.forward = normalize(along);
  const Vec3 side = cross(c.forward, up);
  // `up` is parallel to the view: any side vector will do.
  c.right = length(side) > 1e-6f * length(up) ? normalize(side) : Frame(c.forward).tangent;
  c.up = cross(c.right, c.forward);
  c.half_extent = float(std::tan(rad_from_deg(double(fov_deg)) / 2));
  c.fov_is_vertical = false;
  return c;
}

Camera default_camera(const Scene& scene, const Vec3& up_hint) {
  const Box box = bounds(scene);
  if (box.is_empty()) return look_at({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 60);
  // Most scenes are rooms: stand near a corner at eye height and look across. The eye is inside the
  // bounds, which also suits single objects.
  const Vec3 e = box.extent(), tall = abs(up_hint);
  const Vec3 up = tall.x > tall.y && tall.x > tall.z ? Vec3{1, 0, 0}
                  : tall.y > tall.z                  ? Vec3{0, 1, 0}
                                                     : Vec3{0, 0, 1};
  const Vec3 floor_eye = box.lower + e * 0.04f;
  const Vec3 flat = Vec3{1} - up;
  const Vec3 eye = floor_eye * flat + (box.lower + e * 0.55f) * up;
  const Vec3 target = (box.lower + e * 0.6f) * flat + (box.lower + e * 0.35f) * up;
  Camera c = look_at(eye, target, up, 70);
  return c;
}

}  // namespace troffer
