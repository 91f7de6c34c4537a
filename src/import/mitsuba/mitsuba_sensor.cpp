#include "import/mitsuba/mitsuba_sensor.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "import/limits.h"
#include "import/mitsuba/mitsuba_values.h"

namespace troffer {

namespace {

struct Film {
  int width = 768, height = 576;  // size of the whole picture, in pixels
  int crop_x = 0, crop_y = 0, crop_width = 0, crop_height = 0;
};

Film read_film(const MitsubaNode& sensor, const MitsubaTree& tree) {
  Film film;
  for (const MitsubaNode* child : sensor.children) {
    const MitsubaNode& node = tree.resolved(*child);
    if (node.tag != "film") continue;
    child->is_used = true;
    film.width = get_integer(node, "width", film.width);
    film.height = get_integer(node, "height", film.height);
    if (film.width < 1 || film.width > max_picture_side || film.height < 1 ||
        film.height > max_picture_side)
      node.place.fail("width and height of the film must lie in [1, 65536]");
    film.crop_x = get_integer(node, "crop_offset_x", 0);
    film.crop_y = get_integer(node, "crop_offset_y", 0);
    film.crop_width = get_integer(node, "crop_width", film.width);
    film.crop_height = get_integer(node, "crop_height", film.height);
    if (film.crop_x < 0 || film.crop_y < 0 || film.crop_width < 1 || film.crop_height < 1 ||
        film.crop_width > film.width - film.crop_x || film.crop_height > film.height - film.crop_y)
      node.place.fail("the film's crop lies outside of it");
    return film;
  }
  film.crop_width = film.width;
  film.crop_height = film.height;
  return film;
}

// Sets position and axes. The sensor looks along +z, with +y up and +x to the left. Returns the
// scale of its x axis.
double set_frame(const MitsubaNode& node, const Vec3d& origin, Camera& camera,
                 WarningLog& warnings) {
  const Affine world = get_transform(node, "to_world");
  const Vec3d &x = world.columns[0], &y = world.columns[1], &z = world.columns[2];
  const double determinant = world.determinant();
  if (!(std::abs(determinant) > 0) || !std::isfinite(determinant))
    node.place.fail("the sensor's to_world has no inverse");
  const double skew = std::max({std::abs(dot(x, y)) / (length(x) * length(y)),
                                std::abs(dot(y, z)) / (length(y) * length(z)),
                                std::abs(dot(z, x)) / (length(z) * length(x))});
  if (skew > 1e-3) warnings.add("the sensor's transform shears: the shear is ignored");
  const Vec3d forward = normalize(z);
  const Vec3d up = normalize(y - forward * dot(y, forward));
  Vec3d right = cross(forward, up);
  if (dot(right, x) > 0) right = -right;
  camera.forward = Vec3(forward);
  camera.up = Vec3(up);
  camera.right = Vec3(right);
  camera.position = Vec3(world.translation - origin);
  if (!is_finite(camera.position)) node.place.fail("the sensor's to_world is out of range");
  return length(x);
}

// Sets the part of the image plane that the crop shows. Mitsuba adds the offset of the principal
// point to the place of a pixel, so the optical axis meets the film at 0.5 - offset.
void set_window(const MitsubaNode& node, const Film& film, Camera& camera) {
  const double dx = 2 * get_number(node, "principal_point_offset_x", 0);
  const double dy = 2 * get_number(node, "principal_point_offset_y", 0);
  const bool is_whole = film.crop_width == film.width && film.crop_height == film.height;
  camera.width = film.crop_width;
  camera.height = film.crop_height;
  camera.aspect = float(film.crop_width) / float(film.crop_height);
  if (is_whole && dx == 0 && dy == 0) return;
  const double aspect = double(film.width) / double(film.height);
  const auto x = [&](int pixel) { return aspect * (2.0 * pixel / film.width - 1 + dx); };
  const auto y = [&](int pixel) { return 1 - dy - 2.0 * pixel / film.height; };
  camera.has_screen_window = true;
  camera.screen_window = {float(x(film.crop_x)), float(x(film.crop_x + film.crop_width)),
                          float(y(film.crop_y + film.crop_height)), float(y(film.crop_y))};
}

// Distances along the viewing direction; 0 means no limit. Mitsuba's defaults, 0.01 and 10 000, are
// not applied.
void set_clip(const MitsubaNode& node, Camera& camera) {
  camera.near_clip = float(get_number(node, "near_clip", 0));
  camera.far_clip = float(get_number(node, "far_clip", 0));
  const bool is_fine = camera.near_clip >= 0 && std::isfinite(camera.near_clip) &&
                       std::isfinite(camera.far_clip) &&
                       (camera.far_clip == 0 || camera.far_clip > camera.near_clip);
  if (!is_fine) node.place.fail("0 < near_clip < far_clip expected");
}

}  // namespace

// Without `fov`, a lens of `focal_length` on 36 x 24 mm film of the same diagonal decides.
double mitsuba_vertical_extent(const MitsubaNode& node, double aspect) {
  std::string axis = get_text(node, "fov_axis", "x");
  std::transform(axis.begin(), axis.end(), axis.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  const MitsubaNode* fov = find_parameter(node, "fov");
  const MitsubaNode* focal = find_parameter(node, "focal_length");
  if (fov && focal) focal->place.fail("either fov or focal_length expected, not both");
  double extent = 0;
  if (fov) {
    const double degrees = get_number(node, "fov", 0);
    if (!(degrees > 0 && degrees < 180)) node.place.fail("fov must lie between 0 and 180 degrees");
    extent = std::tan(rad_from_deg(degrees) / 2);
  } else {
    std::string text = focal ? focal->attribute("value") : "50mm";
    if (text.ends_with("mm")) text.resize(text.size() - 2);
    const std::vector<double> mm = numbers_of(focal ? *focal : node, text);
    if (mm.size() != 1 || !(mm[0] > 0)) focal->place.fail("focal_length must be positive");
    extent = std::hypot(36.0, 24.0) / 2 / mm[0];
    axis = "diagonal";
  }
  if (axis == "smaller") axis = aspect > 1 ? "y" : "x";
  if (axis == "larger") axis = aspect > 1 ? "x" : "y";
  if (axis == "x") return extent / aspect;
  if (axis == "y") return extent;
  if (axis == "diagonal") return extent / std::hypot(1.0, aspect);
  node.place.fail("fov_axis '" + shortened(axis) + "' is not known");
}

void add_mitsuba_camera(const MitsubaNode& node, const MitsubaTree& tree, Scene& scene) {
  if (node.type == "batch") {
    for (const MitsubaNode* child : node.children) {
      const MitsubaNode& inner = tree.resolved(*child);
      if (inner.tag != "sensor" || inner.type == "batch") continue;
      child->is_used = true;
      add_mitsuba_camera(inner, tree, scene);
    }
    return;
  }
  Camera camera;
  camera.name = !node.id.empty()        ? node.id
                : scene.cameras.empty() ? "camera"
                                        : "camera" + std::to_string(scene.cameras.size());
  const bool is_orthographic = node.type == "orthographic";
  if (!is_orthographic && node.type != "perspective" && node.type != "thinlens")
    scene.warnings.add("sensor \"" + shortened(node.type) +
                       "\" is not supported: shown as perspective");
  const Film film = read_film(node, tree);
  const double scale = set_frame(node, scene.origin, camera, scene.warnings);
  camera.fov_is_vertical = true;
  if (is_orthographic) {
    camera.kind = CameraKind::orthographic;
    camera.half_extent = float(scale * film.height / film.width);
  } else {
    camera.half_extent = float(mitsuba_vertical_extent(node, double(film.width) / film.height));
    camera.lens_radius = float(get_number(node, "aperture_radius", 0));
    camera.focal_distance = float(get_number(node, "focus_distance", 1e6));
    if (camera.lens_radius < 0 || !(camera.focal_distance > 0))
      node.place.fail("aperture_radius and focus_distance must be positive");
  }
  if (!(camera.half_extent > 0) || !std::isfinite(camera.half_extent))
    node.place.fail("the sensor sees nothing");
  set_window(node, film, camera);
  set_clip(node, camera);
  for (const char* name : {"shutter_open", "shutter_close", "kc"}) find_parameter(node, name);
  for (const MitsubaNode* child : node.children)
    if (child->tag == "sampler" || child->tag == "ref") child->is_used = true;
  warn_of_unused(node, scene.warnings);
  scene.cameras.push_back(std::move(camera));
}

}  // namespace troffer
