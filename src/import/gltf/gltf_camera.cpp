#include "import/gltf/gltf_camera.h"

#include <cmath>

#include "base/units.h"

namespace troffer {

namespace {

double positive_number(const JsonNode& node) {
  const double value = node.as_number();
  if (!(value > 0)) node.fail("must be greater than 0");
  return value;
}

void read_perspective(const JsonNode& perspective, Camera& camera) {
  camera.kind = CameraKind::perspective;
  const JsonNode yfov = perspective.member("yfov");
  if (!(positive_number(yfov) < pi)) yfov.fail("must be less than pi");
  camera.half_extent = float(std::tan(yfov.as_number() / 2));
  if (const auto aspect = perspective.find("aspectRatio"))
    camera.aspect = float(positive_number(*aspect));
}

// Reads xmag and ymag, half of the visible width and height [1] §3.10.3.3. Ignores their signs,
// because some exporters write negative ones.
void read_orthographic(const JsonNode& orthographic, Camera& camera) {
  camera.kind = CameraKind::orthographic;
  const JsonNode xmag = orthographic.member("xmag"), ymag = orthographic.member("ymag");
  for (const JsonNode& mag : {xmag, ymag})
    if (mag.as_number() == 0) mag.fail("must not be 0");
  camera.half_extent = float(std::abs(ymag.as_number()));
  camera.aspect = float(std::abs(xmag.as_number() / ymag.as_number()));
}

}  // namespace

std::optional<Camera> gltf_camera(const JsonNode& node, const Affine& world_from_node,
                                  const std::string& name, WarningLog& warnings) {
  Camera camera;
  camera.name = name;
  const std::string& type = node.member("type").as_string();
  if (type == "orthographic")
    read_orthographic(node.member(type), camera);
  else
    read_perspective(node.member("perspective"), camera);
  camera.fov_is_vertical = true;

  // Gram-Schmidt, forward first. `right` keeps its side, so that a mirroring node mirrors the
  // picture.
  const Vec3d back = world_from_node.columns[2];
  const double back_length = length(back);
  const Vec3d forward = back * (-1 / back_length);
  Vec3d up = world_from_node.columns[1];
  up -= forward * dot(up, forward);
  const double up_length = length(up);
  up *= 1 / up_length;
  Vec3d right = cross(forward, up);
  if (world_from_node.swaps_handedness()) right = -right;
  if (!(back_length > 0) || !(up_length > 0) || !is_finite(right) ||
      !is_finite(Vec3(world_from_node.translation)) || !is_finite(up)) {
    warnings.add("camera '" + printable(name) + "': its node's transform cannot be used; left out");
    return std::nullopt;
  }
  camera.position = Vec3(world_from_node.translation);
  camera.forward = Vec3(forward);
  camera.up = Vec3(up);
  camera.right = Vec3(right);
  return camera;
}

}  // namespace troffer
