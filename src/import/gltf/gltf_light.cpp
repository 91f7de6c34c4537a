#include "import/gltf/gltf_light.h"

#include <cmath>

#include "base/units.h"

namespace troffer {

namespace {

Rgb emission_of(const JsonNode& light) {
  const std::vector<double> color = light.numbers_or("color", {1, 1, 1});
  const double intensity = light.number_or("intensity", 1);
  const Rgb e(float(color[0] * intensity), float(color[1] * intensity),
              float(color[2] * intensity));
  if (!(e.r >= 0 && e.g >= 0 && e.b >= 0) || !is_finite(e))
    light.fail("its color times its intensity is negative or too large");
  return e;
}

// Reads the cone angles: 0 <= inner < outer <= pi/2 [1]. Equal angles are allowed too.
void read_cone(const JsonNode& light, Light& e) {
  double inner = 0, outer = pi / 4;
  if (const auto spot = light.find("spot")) {
    inner = spot->number_or("innerConeAngle", 0);
    outer = spot->number_or("outerConeAngle", pi / 4);
    if (!(inner >= 0 && inner <= outer && outer <= pi / 2 + 1e-3))
      spot->fail("its angles should be 0 <= innerConeAngle < outerConeAngle <= pi/2");
  }
  e.cos_outer = float(std::cos(outer));
  e.cos_inner = std::max(float(std::cos(inner)), std::nextafter(e.cos_outer, 2.0f));
  e.falloff = SpotFalloff::square;
}

}  // namespace

std::optional<Light> gltf_light(const JsonNode& light, const Affine& world_from_node,
                                const std::string& name, WarningLog& warnings) {
  Light e;
  e.name = name;
  const std::string& type = light.member("type").as_string();
  if (type == "directional")
    e.kind = LightKind::distant;
  else if (type == "point")
    e.kind = LightKind::point;
  else if (type == "spot")
    e.kind = LightKind::spot;
  else {
    warnings.add("light '" + printable(name) + "': type '" + printable(type) +
                 "' is not known; left out");
    return std::nullopt;
  }
  e.radiance = emission_of(light);
  if (e.kind == LightKind::spot) read_cone(light, e);
  if (const auto range = light.find("range"); range && e.kind != LightKind::distant) {
    if (!(range->as_number() > 0)) range->fail("must be greater than 0");
    e.range = float(std::min(range->as_number(), 1e18));
  }
  e.position = Vec3(world_from_node.translation);
  const Vec3d back = world_from_node.columns[2];
  const double size = length(back);
  const bool is_turned = size > 0 && std::isfinite(size);
  if (is_turned) e.direction = Vec3(back * (-1 / size));
  if ((!is_turned && e.kind != LightKind::point) || !is_finite(e.position)) {
    warnings.add("light '" + printable(name) + "': its node's transform cannot be used; left out");
    return std::nullopt;
  }
  return e;
}

}  // namespace troffer
