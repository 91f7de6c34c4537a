#include "import/pbrt/pbrt_light.h"

#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/units.h"
#include "import/environment_file.h"
#include "import/file.h"
#include "import/texture_loader.h"
#include "scene/portal_corners.h"
#include "scene/projected_image.h"

namespace troffer {

namespace {

class PbrtLightReader {
 public:
  PbrtLightReader(const PbrtParams& params, const Affine& world_from_light,
                  const PbrtSpectrumContext& context, Scene& scene)
      : params_(params), transform_(world_from_light), context_(context), scene_(scene) {}

  std::optional<Light> point() {
    Light e;
    e.kind = LightKind::point;
    e.radiance = emission("I") * scale_with("power", 4 * pi);
    return place(e, vector("from", {})) ? std::optional(e) : std::nullopt;
  }

  // Full intensity within coneangle - conedeltaangle; dark beyond coneangle [1].
  std::optional<Light> spot() {
    Light e;
    e.kind = LightKind::spot;
    const double cone = angle("coneangle", 30), delta = angle("conedeltaangle", 5);
    const double outer = std::cos(rad_from_deg(cone));
    const double inner = std::cos(rad_from_deg(std::max(0.0, cone - delta)));
    e.cos_outer = float(outer);
    e.cos_inner = std::max(float(inner), std::nextafter(e.cos_outer, 2.0f));
    e.radiance = emission("I") * scale_with("power", 2 * pi * ((1 - inner) + (inner - outer) / 2));
    const Vec3d from = vector("from", {}), to = vector("to", {0, 0, 1});
    if (!turn(e, to - from) || !place(e, from)) return std::nullopt;
    return e;
  }

  std::optional<Light> distant() {
    Light e;
    e.kind = LightKind::distant;
    e.radiance = emission("L") * scale_with("illuminance", 1);
    const Vec3d from = vector("from", {}), to = vector("to", {0, 0, 1});
    return turn(e, to - from) ? std::optional(e) : std::nullopt;
  }

  // Intensity from an equal-area image of all directions. The image's z is the light's y [1].
  std::optional<Light> goniometric() {
    Light e;
    e.kind = LightKind::point;
    const std::string file = params_.get_string("filename", "");
    if (!read_image(file) || !set_axes(e)) return std::nullopt;
    std::swap(e.axes[1], e.axes[2]);
    EnvironmentMap& map = scene_.environments.back();
    if (map.projection != SphereMap::equal_area) {
      context_.warnings.add("image '" + file + "' of a goniometric light is not square: left out");
      return std::nullopt;
    }
    Rgb sum;
    for (Rgb& texel : map.texels) {
      texel = Rgb{(texel.r + texel.g + texel.b) / 3};
      sum += texel;
    }
    const double mean = double(sum.g) / double(map.texels.size());
    e.environment = int32_t(scene_.environments.size()) - 1;
    e.radiance = emission("I") * scale_with("power", mean > 0 ? 4 * pi * mean : 1);
    return place(e, {}) ? std::optional(e) : std::nullopt;
  }

  // Slide projector: the image's shorter side spans `fov`; its top points along the light's y [1].
  std::optional<Light> projection() {
    Light e;
    e.kind = LightKind::point;
    const std::string file = params_.get_string("filename", "");
    const double fov = params_.get_float("fov", 90);
    if (!(fov > 0 && fov < 180)) fail_at(params_.find("fov")->place, "fov must lie in (0, 180)");
    const ConfinedPath path = confined_path(context_.folder, file);
    if (!set_axes(e)) return std::nullopt;
    if (!path.is_fine()) {
      context_.warnings.add("image '" + file + "' of a projection light: " + path.problem +
                            "; the light is left out");
      return std::nullopt;
    }
    Texture look;
    look.is_srgb = true;
    look.wrap_u = look.wrap_v = WrapMode::clamp;
    e.texture = TextureLoader(scene_).from_file(path.path, look);
    const Texture& t = scene_.textures[size_t(e.texture)];
    if (t.kind != TextureKind::image) return std::nullopt;
    const double half = std::tan(rad_from_deg(fov / 2)), aspect = double(t.width) / t.height;
    e.axes[0] = e.axes[0] * float(1 / (half * std::max(aspect, 1.0)));
    e.axes[1] = e.axes[1] * float(-1 / (half * std::max(1 / aspect, 1.0)));
    const auto all = double(luminance(projected_flux(scene_, e)));
    e.radiance = emission("I") * scale_with("power", all > 0 ? all : 1);
    return place(e, {}) ? std::optional(e) : std::nullopt;
  }

  std::optional<Light> infinite() {
    Light e;
    e.kind = LightKind::environment;
    e.portal = portal();
    const std::string file = params_.get_string("filename", "");
    if (file.empty()) {
      e.radiance = emission("L") * scale_with("illuminance", pi);
      return e;
    }
    if (const PbrtParam* radiance = params_.find("L"))
      fail_at(radiance->place, "an infinite light has either \"L\" or \"filename\"");
    if (!read_image(file) || !set_axes(e)) return std::nullopt;
    const EnvironmentMap& map = scene_.environments.back();
    e.environment = int32_t(scene_.environments.size()) - 1;
    // Irradiance on a horizontal plane in the image's own space.
    const auto mean = double(luminance(irradiance_from_above(map)));
    e.radiance = Rgb{1} * scale_with("illuminance", mean > 0 ? mean : 1);
    return e;
  }

 private:
  Rgb emission(const char* name) {
    const PbrtParam* p = params_.find(name);
    return p != nullptr ? emission_value(*p, context_) : Rgb{1};
  }

  // Returns `scale`. If the parameter `name` is given, returns the factor that reaches that total;
  // `of_one` is the total of a light of value 1.
  float scale_with(const char* name, double of_one) {
    const double scale = params_.get_float("scale", 1);
    if (!(scale >= 0)) fail_at(params_.find("scale")->place, "scale must not be negative");
    const double wanted = params_.get_float(name, 0);
    return float(wanted > 0 ? scale * wanted / of_one : scale);
  }

  double angle(const char* name, double fallback) {
    const double deg = params_.get_float(name, fallback);
    if (!(deg >= 0 && deg <= 180))
      fail_at(params_.find(name)->place, std::string(name) + " must lie between 0 and 180 degrees");
    return deg;
  }

  Vec3d vector(const char* name, const Vec3d& fallback) {
    const std::vector<double>& v = params_.numbers(name, PbrtType::point3);
    if (v.empty()) return fallback;
    const Vec3d p = v.size() == 3 ? Vec3d{v[0], v[1], v[2]} : Vec3d{NAN};
    if (!is_finite(p))
      fail_at(params_.find(name)->place, std::string(name) + ": one point expected");
    return p;
  }

  // Portal rectangle, in world space whatever the light's transform is. Its corners run
  // counterclockwise as seen from the side that its light reaches [2].
  std::vector<Vec3> portal() {
    const std::vector<double>& v = params_.numbers("portal", PbrtType::point3);
    if (v.empty()) return {};
    std::vector<Vec3d> p;
    for (size_t i = 0; i + 2 < v.size(); i += 3)
      p.push_back(Vec3d{v[i], v[i + 1], v[i + 2]} - scene_.origin);
    if (v.size() % 3 == 0 && is_rectangle(p))
      return {Vec3(p[0]), Vec3(p[1]), Vec3(p[2]), Vec3(p[3])};
    context_.warnings.add(
        "LightSource \"infinite\": its portal is not a rectangle of four corners and is ignored; "
        "light comes from all unoccluded directions");
    return {};
  }

  bool place(Light& e, const Vec3d& local) {
    e.position = Vec3(transform_.point(local));
    return is_usable(is_finite(e.position));
  }
  bool turn(Light& e, const Vec3d& local) {
    const Vec3d v = transform_.vector(local);
    const double size = length(v);
    if (!is_usable(size > 0 && std::isfinite(size))) return false;
    e.direction = Vec3(v / size);
    return true;
  }

  // Sets the image's axes in the world: the transform without its scale.
  bool set_axes(Light& e) {
    const auto& c = transform_.columns;
    const Vec3d z = normalize(c[2]);
    const Vec3d x = normalize(c[0] - z * dot(c[0], z));
    const Vec3d y = cross(z, x) * (transform_.swaps_handedness() ? -1 : 1);
    if (!is_usable(is_finite(x) && is_finite(y) && is_finite(z))) return false;
    if (length(normalize(c[1]) - y) > 1e-3 || std::abs(dot(normalize(c[0]), z)) > 1e-3)
      context_.warnings.add(
          "image light whose transform is more than a rotation: only the rotation is used");
    e.axes = {Vec3(x), Vec3(y), Vec3(z)};
    return true;
  }

  bool is_usable(bool is) {
    if (!is) context_.warnings.add("LightSource whose place or direction cannot be used: left out");
    return is;
  }

  bool read_image(const std::string& file) {
    const ConfinedPath path = confined_path(context_.folder, file);
    std::string problem = path.problem;
    if (path.is_fine() && scene_.skipped_image_bytes) {
      *scene_.skipped_image_bytes += size_of_left_out(path.path);
      return false;
    }
    if (path.is_fine()) {
      try {
        scene_.environments.push_back(read_environment(path.path, context_.warnings));
        return true;
      } catch (const InputError& error) {
        problem = error.reason();
      }
    }
    context_.warnings.add("image '" + file + "' of a light: " + problem +
                          "; the light is left out");
    return false;
  }

  const PbrtParams& params_;
  const Affine& transform_;
  const PbrtSpectrumContext& context_;
  Scene& scene_;
};

}  // namespace

std::optional<Light> read_pbrt_light(const std::string& type, const PbrtParams& params,
                                     const Affine& world_from_light,
                                     const PbrtSpectrumContext& context, Scene& scene) {
  Affine from_origin = world_from_light;
  from_origin.translation -= scene.origin;
  PbrtLightReader reader(params, from_origin, context, scene);
  std::optional<Light> light;
  if (type == "point") {
    light = reader.point();
  } else if (type == "spot") {
    light = reader.spot();
  } else if (type == "distant") {
    light = reader.distant();
  } else if (type == "goniometric") {
    light = reader.goniometric();
  } else if (type == "projection") {
    light = reader.projection();
  } else if (type == "infinite") {
    light = reader.infinite();
  } else {
    params.ignore_all();
    context.warnings.add("LightSource \"" + type + "\" is not supported: left out");
  }
  if (light)
    params.warn_unread(context.warnings);
  else
    params.ignore_all();  // a warning has already given the reason
  if (light && !is_finite(light->radiance)) {
    context.warnings.add("LightSource too bright for a number: left out");
    light.reset();
  }
  return light;
}

}  // namespace troffer
