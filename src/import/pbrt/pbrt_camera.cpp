#include "import/pbrt/pbrt_camera.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "import/file.h"
#include "import/limits.h"
#include "import/pbrt/pbrt_lens.h"

namespace troffer {

namespace {

int resolution(const PbrtParams& params, const char* name, int fallback) {
  const int n = params.get_int(name, fallback);
  if (n < 1 || n > max_picture_side)
    fail_at(params.find(name)->place,
            std::string(name) + " must be in [1, " + std::to_string(max_picture_side) + "]");
  return n;
}

// Position relative to `origin`. The position has gone through the camera transform and its inverse
// in world coordinates, which leaves an error in the last digits of a far position. Rounding
// removes it, so that a camera on a coordinate plane of its scene stays there.
Vec3d from_origin(const Vec3d& p, const Vec3d& origin) {
  if (origin == Vec3d{}) return p;
  const Vec3d reach = abs(origin);
  const int digits = 47 - std::ilogb(std::max({reach.x, reach.y, reach.z}));
  Vec3d out = p - origin;
  for (size_t a = 0; a < 3; ++a)
    out[a] = std::ldexp(std::round(std::ldexp(out[a], digits)), -digits) + 0.0;
  return out;
}

// Sets position and axes. Returns the uniform part of the scale, in world units per unit of camera
// space.
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
    warnings.add("the camera's transform stretches or shears: this is ignored");
  // Makes the axes orthonormal to the last bit, with the handedness of the file.
  const Vec3d f = forward / sz;
  const Vec3d r = normalize(right - f * dot(right, f));
  const Vec3d u = cross(f, r);
  camera.position = Vec3(from_origin(world.translation, origin));
  camera.forward = Vec3(f);
  camera.right = Vec3(r);
  camera.up = Vec3(dot(u, up) < 0 ? -u : u);
  return scale;
}

// Pixels x0 x1 y0 y1 of cropwindow (fractions of the picture) or pixelbounds (pixels).
std::array<int, 4> film_window(const PbrtParams& params, const PbrtFilm& film) {
  std::array<int, 4> window{0, film.width, 0, film.height};
  const std::array<int, 4> sizes{film.width, film.width, film.height, film.height};
  const auto& crop = params.numbers("cropwindow", PbrtType::real);
  const auto& pixels = params.numbers("pixelbounds", PbrtType::integer);
  const PbrtParam* given = params.find(pixels.empty() ? "cropwindow" : "pixelbounds");
  if (!given) return window;
  if ((pixels.empty() ? crop : pixels).size() != 4) fail_at(given->place, "four numbers expected");
  for (size_t i = 0; i < 4; ++i) {
    const double at =
        pixels.empty() ? std::ceil(sizes[i] * std::clamp(crop[i], 0.0, 1.0)) : pixels[i];
    window[i] = int(std::clamp(at, 0.0, double(sizes[i])));
  }
  if (window[0] >= window[1] || window[2] >= window[3])
    fail_at(given->place, "the film's window has no pixels");
  return window;
}

// Reduces the picture and the image plane to the film's window.
void crop_screen_window(Camera& camera, const PbrtFilm& film) {
  const auto& w = film.window;
  camera.width = w[1] - w[0];
  camera.height = w[3] - w[2];
  camera.aspect = float(double(camera.width) / double(camera.height));
  if (camera.width == film.width && camera.height == film.height) return;
  const double aspect = double(film.width) / double(film.height);
  const double wide = std::max(aspect, 1.0), high = std::max(1 / aspect, 1.0);
  std::array<double, 4> all{-wide, wide, -high, high};
  if (camera.has_screen_window)
    for (size_t i = 0; i < 4; ++i) all[i] = double(camera.screen_window[i]);
  const auto x = [&](int pixel) { return float(all[0] + (all[1] - all[0]) * pixel / film.width); };
  const auto y = [&](int pixel) { return float(all[3] - (all[3] - all[2]) * pixel / film.height); };
  camera.has_screen_window = true;
  camera.screen_window = {x(w[0]), x(w[1]), y(w[3]), y(w[2])};
}

// Approximates a realistic camera by a thin lens of the same focal length, aperture and focus, and
// adds a warning that says so.
void set_realistic_lens(Camera& camera, const PbrtParams& params, const PbrtFilm& film,
                        double scale, const std::string& folder, WarningLog& warnings) {
  const std::string file = params.get_string("lensfile", "");
  const double aperture_mm = params.get_float("aperturediameter", 1);
  const double focus = params.get_float("focusdistance", 10);
  const ConfinedPath path = confined_path(folder, file);
  std::string problem = path.problem;
  if (path.is_fine()) {
    try {
      const PbrtLens lens = read_pbrt_lens(path.path, aperture_mm);
      if (!(focus > lens.focal_length)) fail_at(params.place, "focusdistance is within the lens");
      const double image = 1 / (1 / lens.focal_length - 1 / focus);
      const double diagonal = film.diagonal_mm / 1000;
      const double shorter = diagonal * std::min(film.width, film.height) /
                             std::hypot(double(film.width), double(film.height));
      camera.half_extent = float(shorter / 2 / image);
      camera.lens_radius = float(lens.pupil_radius * scale);
      camera.focal_distance = float(std::min(focus * scale, 1e30));
      warnings.add("camera \"realistic\": a thin lens of its focal length, opening and focus");
      return;
    } catch (const InputError& error) {
      problem = error.reason();
    }
  }
  warnings.add("lens file '" + file + "': " + problem + "; shown as perspective of 90 degrees");
  camera.half_extent = 1;
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

void set_thin_lens(Camera& camera, const PbrtParams& params, double scale) {
  const double lens = params.get_float("lensradius", 0) * scale;
  const double focus = params.get_float("focaldistance", 1e6) * scale;
  if (lens < 0) fail_at(params.find("lensradius")->place, "lensradius must not be negative");
  if (!(focus > 0)) fail_at(params.find("focaldistance")->place, "focaldistance must be positive");
  camera.lens_radius = float(lens);
  camera.focal_distance = float(std::min(focus, 1e30));
}

}  // namespace

PbrtFilm read_pbrt_film(const std::string& type, const PbrtParams& params, WarningLog& warnings) {
  if (type != "rgb" && type != "gbuffer" && type != "spectral")
    warnings.add("film \"" + type + "\" is unknown: read as \"rgb\"");
  PbrtFilm film;
  film.width = resolution(params, "xresolution", film.width);
  film.height = resolution(params, "yresolution", film.height);
  film.window = film_window(params, film);
  film.diagonal_mm = params.get_float("diagonal", film.diagonal_mm);
  if (!(film.diagonal_mm > 0)) fail_at(params.find("diagonal")->place, "must be positive");
  const std::string sensor = params.get_string("sensor", "cie1931");
  if (sensor != "cie1931")
    warnings.add("film sensor \"" + sensor + "\" is not simulated: linear sRGB radiance instead");
  const double iso = params.get_float("iso", 100), seconds = params.get_float("exposuretime", 1);
  if (iso * seconds != 100 || params.get_float("whitebalance", 0) != 0)
    warnings.add("iso, exposuretime and whitebalance of the film are ignored");
  params.ignore({"filename", "savefp16", "maxcomponentvalue", "coordinatesystem", "nbuckets",
                 "lambdamin", "lambdamax"});
  params.warn_unread(warnings);
  return film;
}

Camera read_pbrt_camera(const std::string& type, const PbrtParams& params,
                        const Affine& camera_from_world, const Vec3d& origin, const PbrtFilm& film,
                        const std::string& folder, WarningLog& warnings) {
  Camera camera;
  camera.name = "camera";
  const bool is_realistic = type == "realistic";
  const bool is_known = type == "perspective" || type == "orthographic" || is_realistic;
  if (!is_known) warnings.add("camera \"" + type + "\" is not supported: shown as perspective");
  camera.kind = type == "orthographic" ? CameraKind::orthographic : CameraKind::perspective;
  const double scale = set_frame(camera, camera_from_world, origin, params, warnings);
  camera.fov_is_vertical = false;
  if (is_realistic) {
    set_realistic_lens(camera, params, film, scale, folder, warnings);
    params.ignore({"aperture", "scale"});
  } else if (camera.kind == CameraKind::perspective) {
    const double fov_deg = params.get_float("fov", 90);
    if (!(fov_deg > 0 && fov_deg < 180))
      fail_at(params.find("fov")->place, "fov must lie between 0 and 180 degrees");
    camera.half_extent = float(std::tan(rad_from_deg(fov_deg) / 2));
  } else {
    camera.half_extent = float(scale);
  }
  set_screen_window(camera, params, film);
  if (!is_realistic) set_thin_lens(camera, params, scale);
  crop_screen_window(camera, film);
  params.ignore({"shutteropen", "shutterclose"});
  if (is_known)
    params.warn_unread(warnings);
  else
    params.ignore_all();
  return camera;
}

}  // namespace troffer
