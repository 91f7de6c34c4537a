#include "import/mitsuba/mitsuba_light.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/units.h"
#include "import/environment_file.h"
#include "import/file.h"
#include "import/mitsuba/mitsuba_daylight.h"
#include "import/mitsuba/mitsuba_sensor.h"
#include "import/mitsuba/mitsuba_values.h"
#include "import/texture_loader.h"

namespace troffer {

namespace {

// Resamples rows: Mitsuba's first and last rows lie on the poles, ours half a row inside. Output
// rows lie between those of the file; there are enough of them to blur little.
EnvironmentMap from_pole_to_pole(EnvironmentMap map) {
  constexpr size_t most_texels = size_t(1) << 23;
  const int steps = map.height - 1;
  if (steps < 1) return map;
  const int finer = steps < 64 ? 16 : steps < 512 ? 4 : 2;
  EnvironmentMap out;
  out.name = map.name;
  out.projection = map.projection;
  out.width = map.width;
  out.height = steps * finer;
  if (size_t(out.width) * size_t(out.height) > most_texels) out.height = map.height;
  out.texels.reserve(size_t(out.width) * size_t(out.height));
  for (int y = 0; y < out.height; ++y) {
    const double at = (y + 0.5) / out.height * steps;
    const int above = std::min(int(at), steps - 1);
    const auto share = float(at - above);
    const Rgb* const row = map.texels.data() + size_t(above) * size_t(map.width);
    for (int x = 0; x < map.width; ++x)
      out.texels.push_back(row[x] * (1 - share) + row[x + map.width] * share);
  }
  return out;
}

class MitsubaLightReader {
 public:
  MitsubaLightReader(const MitsubaNode& node, const MitsubaTree& tree, MitsubaTextures& textures,
                     Scene& scene)
      : node_(node),
        tree_(tree),
        textures_(textures),
        scene_(scene),
        world_(get_transform(node, "to_world")) {}

  void read();

 private:
  const MitsubaNode& node_;
  const MitsubaTree& tree_;
  MitsubaTextures& textures_;
  Scene& scene_;
  Affine world_;

  Rgb color(const char* name, Rgb fallback) {
    const MitsubaNode* p = find_parameter(node_, name);
    if (!p) return fallback;
    const ColorInput c = textures_.emission(*p);
    if (c.texture < 0) return c.value;
    scene_.warnings.add(label() + "its texture is not supported: shown uniform");
    return fallback;
  }
  std::string label() const { return "emitter \"" + shortened(node_.type) + "\": "; }
  void add(Light e);
  bool turn(Light& e, const Vec3d& direction);
  bool set_axes(Light& e);
  void point();
  void spot();
  void projector();
  void project_picture(Light& e, int32_t texture, double half_width, double half_height);
  bool is_checkerboard(const MitsubaNode& texture) const;
  void directional();
  void envmap();
};

void MitsubaLightReader::add(Light e) {
  if (!is_finite(e.radiance)) {
    scene_.warnings.add(label() + "too bright for a number: left out");
    return;
  }
  if (!is_finite(e.position)) {
    scene_.warnings.add(label() + "its position cannot be used: left out");
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
  add(std::move(e));
}

// Intensity falls linearly with the angle from beam_width to cutoff_angle. A texture spans the
// cone.
void MitsubaLightReader::spot() {
  Light e;
  e.kind = LightKind::spot;
  const double cutoff = get_number(node_, "cutoff_angle", 20);
  const double beam = get_number(node_, "beam_width", cutoff * 3 / 4);
  if (!(cutoff > 0 && cutoff <= 180) || !(beam >= 0 && beam <= cutoff))
    node_.place.fail("spot: 0 <= beam_width <= cutoff_angle <= 180 expected");
  e.cos_outer = float(std::cos(rad_from_deg(cutoff)));
  e.cos_inner = std::max(float(std::cos(rad_from_deg(beam))), std::nextafter(e.cos_outer, 2.0f));
  if (e.cos_inner - e.cos_outer > 1e-5f) e.falloff = SpotFalloff::linear;
  e.radiance = color("intensity", Rgb{1});
  e.position = Vec3(world_.translation - scene_.origin);
  if (const MitsubaNode* picture = find_parameter(node_, "texture")) {
    const ColorInput c = textures_.color(*picture);
    e.radiance *= c.value;
    if (cutoff < 90)
      project_picture(e, c.texture, std::tan(rad_from_deg(cutoff)), std::tan(rad_from_deg(cutoff)));
    else
      scene_.warnings.add(label() + "its texture is not supported at a width of 180 degrees");
  }
  if (turn(e, world_.columns[2])) add(std::move(e));
}

// Projects a picture of that half width and height at distance 1, with its first row at -y. The
// axes are those of to_world without its scale.
void MitsubaLightReader::project_picture(Light& e, int32_t texture, double half_width,
                                         double half_height) {
  if (texture < 0) return;
  const Vec3d z = normalize(world_.columns[2]);
  const Vec3d x = normalize(world_.columns[0] - z * dot(world_.columns[0], z));
  const Vec3d y = cross(z, x) * (world_.swaps_handedness() ? -1 : 1);
  if (!is_finite(x) || !is_finite(y) || !is_finite(z)) return;
  e.texture = texture;
  e.axes = {Vec3(x / half_width), Vec3(y / half_height), Vec3(z)};
}

// Inverse of a camera: lights each plane across its axis in proportion to the picture. Emits pi
// times `irradiance` at distance 1.
void MitsubaLightReader::projector() {
  Light e;
  e.kind = LightKind::point;
  e.has_uniform_plane = true;
  const MitsubaNode* given = find_parameter(node_, "irradiance");
  ColorInput c = given ? textures_.emission(*given) : ColorInput{};
  double aspect = 1;
  if (c.texture < 0) {
    Texture even;
    even.name = "even light of a projector";
    scene_.textures.push_back(std::move(even));
    c.texture = int32_t(scene_.textures.size()) - 1;
  } else if (const Texture& t = scene_.textures[size_t(c.texture)];
             t.kind == TextureKind::image && t.width > 0 && t.height > 0) {
    // A checkerboard texture has no resolution in Mitsuba.
    if (!is_checkerboard(*given)) aspect = double(t.width) / t.height;
  }
  const double half_height = mitsuba_vertical_extent(node_, aspect);
  e.radiance = c.value * float(pi * get_number(node_, "scale", 1));
  e.position = Vec3(world_.translation - scene_.origin);
  // The picture's left is at +x and its top at +y, as for cameras.
  project_picture(e, c.texture, -half_height * aspect, -half_height);
  if (e.texture >= 0) add(std::move(e));
}

bool MitsubaLightReader::is_checkerboard(const MitsubaNode& texture) const {
  return tree_.resolved(texture).type == "checkerboard";
}

void MitsubaLightReader::directional() {
  Light e;
  e.kind = LightKind::distant;
  e.radiance = color("irradiance", Rgb{1});
  const auto given = get_vector(node_, "direction");
  if (turn(e, world_.vector(given.value_or(Vec3d{0, 0, 1})))) add(std::move(e));
}

// The image's +z is the world's +y. Its azimuth runs from -z to +x.
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
  const ConfinedPath path = tree_.file(file);
  std::string problem = path.problem;
  if (path.is_fine() && scene_.skipped_image_bytes) {
    *scene_.skipped_image_bytes += size_of_left_out(path.path);
    return;
  }
  if (!set_axes(e)) return;
  if (path.is_fine()) {
    try {
      EnvironmentMap map = read_environment(path.path, scene_.warnings);
      map.projection = SphereMap::lat_long;
      scene_.environments.push_back(from_pole_to_pole(std::move(map)));
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
  } else if (type == "projector") {
    projector();
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

void add_mitsuba_light(const MitsubaNode& node, const MitsubaTree& tree, MitsubaTextures& textures,
                       Scene& scene) {
  MitsubaLightReader(node, tree, textures, scene).read();
}

}  // namespace troffer
