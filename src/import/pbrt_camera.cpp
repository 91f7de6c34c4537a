#include "import/pbrt_camera.h"

#include <cmath>

#include "import/limits.h"

namespace troffer {

namespace {

int resolution(const PbrtParams& params, const char* name, int fallback) {
  const int n = params.get_int(name, fallback);
  if (n < 1 || n > max_picture_side)
    fail_at(params.find(name)->place,
            std::string(name) + " must be in [1, " + std::to_string(max_picture_side) + "]");
  return n;
}

// A position from `origin`, far from which it went through the transform and back: what is left of
// that in the last digits of the doubles is taken off, so that a camera on a plane of its scene's
// coordinates stays there.
Vec3d from_origin(const Vec3d& p, const Vec3d& origin) {
  if (origin == Vec3d{}) return p;
  const Vec3d reach = abs(origin);
  const int digits = 47 - std::ilogb(std::max({reach.x, reach.y, reach.z}));
  Vec3d out = p - origin;
  for (size_t a = 0; a < 3; ++a)
    out[a] = std::ldexp(std::round(std::ldexp(out[a], digits)), -digits) + 0.0;
  return out;
}

// Position and axes; returns the uniform part of the scale, in metres per unit of camera space.
double set_frame(Camera& camera, const Affine& camera_from_world, const Vec3d& origin,
                 const PbrtParams& params, WarningLog& warnings) {
  const double determinant = camera_from_world.determinant();
  if (!(std::abs(determinant) > 0) || !std::isfinite(determinant))
    fail_at(params.place, "the transform at the camera has no inverse");
  const Affine world = inverse(camera_from_world);
  const Vec3d right = world.columns[0], up = world.columns[1], forward = world.columns[2];
  const double sx = length(right), sy = length(up), sz = length(forward);
  const double scale = std::cbrt(sx * sy * sz);
  if (!std::isfinite(scale) || !(scale > 0) || !is_finite(Vec3(world.translation)))
    fail_at(params.place, "the transform at the camera is out of range");
  const auto differs = [&](double s) { return std::abs(s - scale) > 1e-3 * scale; };
  const double skew =
      std::max({std::abs(dot(right, up)) / (sx * sy), std::abs(dot(up, forward)) / (sy * sz),
                std::abs(dot(forward, right)) / (sz * sx)});
  if (differs(sx) || differs(sy) || differs(sz) || skew > 1e-3)
    warnings.add("the camera's transform stretches or shears: shown without");
  // Orthonormal to the last bit, in the handedness of the file.
  const Vec3d f = forward / sz;
  const Vec3d r = normalize(right - f * dot(right, f));
  const Vec3d u = cross(f, r);
  camera.position = Vec3(from_origin(world.translation, origin));
  camera.forward = Vec3(f);
  camera.right = Vec3(r);
  camera.up = Vec3(dot(u, up) < 0 ? -u : u);
  return scale;
}

void set_screen_window(Camera& camera, const PbrtParams& params, const PbrtFilm& film) {
  const PbrtParam* window = params.find("screenwindow");
  if (window) {
    const auto& w = params.numbers("screenwindow", PbrtType::real);
    if (w.size() != 4 || !(w[0] < w[1]) || !(w[2] < w[3]) || !std::isfinite(w[1] - w[0]) ||
        !std::isfinite(w[3] - w[2]))
      fail_at(window->place, "screenwindow needs four numbers: xmin < xmax, ymin < ymax");
    params.ignore({"frameaspectratio"});
    camera.has_screen_window = true;
    camera.screen_window = {float(w[0]), float(w[1]), float(w[2]), float(w[3])};
    return;
  }
  const double natural = double(film.width) / double(film.height);
  const double frame = params.get_float("frameaspectratio", natural);
  if (!(frame > 0)) fail_at(params.find("frameaspectratio")->place, "must be positive");
  if (std::abs(frame - natural) <= 1e-6 * natural) return;
  const auto wide = float(std::max(frame, 1.0)), high = float(std::max(1 / frame, 1.0));
  camera.has_screen_window = true;
  camera.screen_window = {-wide, wide, -high, high};
}

}  // namespace

PbrtFilm read_pbrt_film(const std::string& type, const PbrtParams& params, WarningLog& warnings) {
  if (type != "rgb" && type != "gbuffer" && type != "spectral")
    warnings.add("film \"" + type + "\" is unknown: read as \"rgb\"");
  PbrtFilm film;
  film.width = resolution(params, "xresolution", film.width);
  film.height = resolution(params, "yresolution", film.height);
  const auto& crop = params.numbers("cropwindow", PbrtType::real);
  const bool is_whole = crop.empty() || crop == std::vector<double>{0, 1, 0, 1};
  if (!is_whole || params.has("pixelbounds"))
    warnings.add("cropping by the film is not supported: the whole image is made (see --crop)");
  const std::string sensor = params.get_string("sensor", "cie1931");
  if (sensor != "cie1931")
    warnings.add("film sensor \"" + sensor + "\" is not simulated: linear sRGB radiance instead");
  const double iso = params.get_float("iso", 100), seconds = params.get_float("exposuretime", 1);
  if (iso * seconds != 100 || params.get_float("whitebalance", 0) != 0)
    warnings.add("iso, exposuretime and whitebalance of the film are ignored");
  params.ignore({"filename", "diagonal", "savefp16", "maxcomponentvalue", "coordinatesystem",
                 "nbuckets", "lambdamin", "lambdamax"});
  params.warn_unread(warnings);
  return film;
}

Camera read_pbrt_camera(const std::string& type, const PbrtParams& params,
                        const Affine& camera_from_world, const Vec3d& origin, const PbrtFilm& film,
                        WarningLog& warnings) {
  Camera camera;
  camera.name = "camera";
  const bool is_known = type == "perspective" || type == "orthographic";
  if (!is_known) warnings.add("camera \"" + type + "\" is not supported: shown as perspective");
  camera.kind = type == "orthographic" ? CameraKind::orthographic : CameraKind::perspective;
  const double scale = set_frame(camera, camera_from_world, origin, params, warnings);
  camera.fov_is_vertical = false;
  if (camera.kind == CameraKind::perspective) {
    const double fov_deg = params.get_float("fov", 90);
    if (!(fov_deg > 0 && fov_deg < 180))
      fail_at(params.find("fov")->place, "fov must lie between 0 and 180 degrees");
    camera.half_extent = float(std::tan(rad_from_deg(fov_deg) / 2));
  } else {
    camera.half_extent = float(scale);
  }
  set_screen_window(camera, params, film);
  const double lens = params.get_float("lensradius", 0) * scale;
  const double focus = params.get_float("focaldistance", 1e6) * scale;
  if (lens < 0) fail_at(params.find("lensradius")->place, "lensradius must not be negative");
  if (!(focus > 0)) fail_at(params.find("focaldistance")->place, "focaldistance must be positive");
  camera.lens_radius = float(lens);
  camera.focal_distance = float(std::min(focus, 1e30));
  camera.width = film.width;
  camera.height = film.height;
  camera.aspect = float(double(film.width) / double(film.height));
  params.ignore({"shutteropen", "shutterclose"});
  if (is_known)
    params.warn_unread(warnings);
  else
    params.ignore_all();
  return camera;
}

}  // namespace troffer
