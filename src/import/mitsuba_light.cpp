#include "import/mitsuba_light.h"

#include <cmath>

#include "base/units.h"
#include "import/environment_file.h"
#include "import/file.h"
#include "import/mitsuba_daylight.h"
#include "import/mitsuba_values.h"
#include "import/texture_loader.h"

namespace troffer {

namespace {

class MitsubaLightReader {
 public:
  MitsubaLightReader(const MitsubaNode& node, const MitsubaTree& tree, Scene& scene)
      : node_(node), tree_(tree), scene_(scene), world_(get_transform(node, "to_world")) {}

  void read();

 private:
  const MitsubaNode& node_;
  const MitsubaTree& tree_;
  Scene& scene_;
  Affine world_;

  Rgb color(const char* name, Rgb fallback) {
    const MitsubaNode* p = find_parameter(node_, name);
    if (!p) return fallback;
    if (is_color(*p)) return color_of(*p, tree_.folder(), scene_.warnings, true);
    scene_.warnings.add(label() + "its texture is not supported: even");
    return fallback;
  }
  std::string label() const { return "emitter \"" + shortened(node_.type) + "\": "; }
  void add(Light e);
  bool turn(Light& e, const Vec3d& direction);
  bool set_axes(Light& e);
  void point();
  void spot();
  void directional();
  void envmap();
};

void MitsubaLightReader::add(Light e) {
  if (!is_finite(e.radiance)) {
    scene_.warnings.add(label() + "too bright for a number: left out");
    return;
  }
  e.name = !node_.id.empty() ? node_.id : "light" + std::to_string(scene_.lights.size());
  scene_.lights.push_back(std::move(e));
}

bool MitsubaLightReader::turn(Light& e, const Vec3d& direction) {
  const double size = length(direction);
  if (!(size > 0) || !std::isfinite(size)) {
    scene_.warnings.add(label() + "its direction cannot be used: left out");
    return false;
  }
  e.direction = Vec3(direction / size);
  return true;
}

void MitsubaLightReader::point() {
  Light e;
  e.kind = LightKind::point;
  e.radiance = color("intensity", Rgb{1});
  const Vec3d at = get_vector(node_, "position").value_or(Vec3d{0});
  e.position = Vec3(world_.point(at) - scene_.origin);
  if (is_finite(e.position)) add(std::move(e));
}

// Linear in the angle between beam_width and cutoff_angle; ours is smooth in its cosine.
void MitsubaLightReader::spot() {
  Light e;
  e.kind = LightKind::spot;
  const double cutoff = get_number(node_, "cutoff_angle", 20);
  const double beam = get_number(node_, "beam_width", cutoff * 3 / 4);
  if (!(cutoff > 0 && cutoff <= 180) || !(beam >= 0 && beam <= cutoff))
    node_.place.fail("spot: 0 <= beam_width <= cutoff_angle <= 180 expected");
  e.cos_outer = float(std::cos(rad_from_deg(cutoff)));
  e.cos_inner = std::max(float(std::cos(rad_from_deg(beam))), std::nextafter(e.cos_outer, 2.0f));
  e.radiance = color("intensity", Rgb{1});
  e.position = Vec3(world_.translation - scene_.origin);
  if (find_parameter(node_, "texture"))
    scene_.warnings.add(label() + "its texture is not supported: even");
  if (beam < cutoff)
    scene_.warnings.add(label() + "fades smoothly, not linearly, between its two angles");
  if (turn(e, world_.columns[2]) && is_finite(e.position)) add(std::move(e));
}

void MitsubaLightReader::directional() {
  Light e;
  e.kind = LightKind::distant;
  e.radiance = color("irradiance", Rgb{1});
  const auto given = get_vector(node_, "direction");
  if (turn(e, world_.vector(given.value_or(Vec3d{0, 0, 1})))) add(std::move(e));
}

// The image's +z is the world's +y, its azimuth runs from -z to +x.
bool MitsubaLightReader::set_axes(Light& e) {
  const Vec3d up = normalize(world_.columns[1]);
  const Vec3d x = normalize(-world_.columns[2] + up * dot(world_.columns[2], up));
  Vec3d y = cross(x, up);
  if (dot(y, world_.columns[0]) < 0) y = -y;
  if (!is_finite(x) || !is_finite(y) || !is_finite(up)) {
    scene_.warnings.add(label() + "its transform cannot be used: left out");
    return false;
  }
  e.axes = {Vec3(x), Vec3(y), Vec3(up)};
  return true;
}

void MitsubaLightReader::envmap() {
  Light e;
  e.kind = LightKind::environment;
  e.radiance = Rgb{float(get_number(node_, "scale", 1))};
  if (!(e.radiance.r >= 0)) node_.place.fail("scale must not be negative");
  const std::string file = get_text(node_, "filename", "");
  const ConfinedPath path = confined_path(tree_.folder(), file);
  std::string problem = path.problem;
  if (path.is_fine() && scene_.left_out_image_bytes) {
    *scene_.left_out_image_bytes += size_of_left_out(path.path);
    return;
  }
  if (path.is_fine() && set_axes(e)) {
    try {
      EnvironmentMap map = read_environment(path.path, scene_.warnings);
      map.projection = SphereMap::lat_long;
      scene_.environments.push_back(std::move(map));
      e.environment = int32_t(scene_.environments.size()) - 1;
      add(std::move(e));
      return;
    } catch (const InputError& error) {
      problem = error.reason();
    }
  }
  scene_.warnings.add("image '" + shortened(file) + "' of an envmap: " + problem +
                      "; the light is left out");
}

void MitsubaLightReader::read() {
  find_parameter(node_, "sampling_weight");
  const std::string& type = node_.type;
  if (type == "point") {
    point();
  } else if (type == "spot") {
    spot();
  } else if (type == "directional") {
    directional();
  } else if (type == "constant") {
    Light e;
    e.kind = LightKind::environment;
    e.radiance = color("radiance", Rgb{1});
    add(std::move(e));
  } else if (type == "envmap") {
    envmap();
  } else if (type == "sky" || type == "sun" || type == "sunsky") {
    add_mitsuba_daylight(node_, tree_, scene_.warnings, [&](Light e) { add(std::move(e)); });
  } else {
    for (const MitsubaNode* child : node_.children) child->is_used = true;
    scene_.warnings.add("emitter \"" + shortened(type) + "\" is not supported: left out");
  }
  warn_of_unused(node_, scene_.warnings);
}

}  // namespace

void add_mitsuba_light(const MitsubaNode& node, const MitsubaTree& tree, Scene& scene) {
  MitsubaLightReader(node, tree, scene).read();
}

}  // namespace troffer
