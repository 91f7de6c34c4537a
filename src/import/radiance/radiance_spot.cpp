#include "import/radiance/radiance_spot.h"

#include <algorithm>
#include <cmath>

#include "base/frame.h"
#include "base/units.h"

namespace troffer {

namespace {

// Factor on areas of a transform; exact for similarities.
double area_scale(const Affine& t) {
  return std::pow(std::abs(t.determinant()), 2.0 / 3);
}

// Web that is 1 (or, for flat surfaces, the cosine) up to an angle from z, and 0 beyond.
LightWeb beam(double half_angle, bool is_flat, const std::string& name) {
  constexpr int steps = 64;
  LightWeb web;
  web.name = name;
  web.horizontal_angles_rad = {0, 2 * pi_f};
  const double end = std::min(half_angle, is_flat ? pi / 2 : pi);
  std::vector<float> shares;
  for (int i = 0; i <= steps; ++i) {
    web.vertical_angles_rad.push_back(float(end * i / steps));
    shares.push_back(is_flat ? std::max(0.0f, float(std::cos(end * i / steps))) : 1);
  }
  for (int turn = 0; turn < 2; ++turn)
    web.intensities.insert(web.intensities.end(), shares.begin(), shares.end());
  return web;
}

}  // namespace

RadianceExtent extent_of_polygon(const std::vector<Vec3d>& corners, const Affine& world,
                                 bool is_inverted) {
  RadianceExtent out;
  double whole = 0;
  Vec3d total;
  for (size_t i = 1; i + 1 < corners.size(); ++i)
    total += cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
  const Vec3d normal = length(total) > 0 ? normalize(total) : Vec3d{};
  for (size_t i = 1; i + 1 < corners.size(); ++i) {
    const double part = dot(cross(corners[i] - corners[0], corners[i + 1] - corners[0]), normal);
    out.middle += (corners[0] + corners[i] + corners[i + 1]) * (part / 3);
    whole += part;
  }
  out.middle = world.point(whole > 0 ? out.middle / whole : corners[0]);
  out.area = world.normal(total / 2) * ((world.swaps_handedness() != is_inverted) ? -1.0 : 1.0);
  return out;
}

RadianceExtent extent_of_round(const RadianceModifier& p, bool is_inverted) {
  const std::vector<double>& v = p.arguments.reals;
  const bool is_ball = p.type == "sphere" || p.type == "bubble";
  const bool is_straight = p.type == "cylinder" || p.type == "tube";
  const size_t needed = is_ball ? 4 : is_straight ? 7 : 8;
  if (v.size() != needed)
    p.place.fail(p.type + " needs " + std::to_string(needed) + " real arguments");
  const double scale = area_scale(p.world);
  const Vec3d first{v[0], v[1], v[2]};
  RadianceExtent out;
  out.middle = p.world.point(first);
  if (is_ball) {
    out.section = pi * sqr(v[3]) * scale;
    return out;
  }
  const Vec3d second{v[3], v[4], v[5]};
  if (p.type == "ring") {
    const Vec3d normal = normalize(p.world.vector(second)) * (is_inverted ? -1.0 : 1.0);
    out.area = normal * (pi * std::abs(sqr(v[7]) - sqr(v[6])) * scale);
    return out;
  }
  out.middle = p.world.point((first + second) * 0.5);
  out.section = length(second - first) * (v[6] + (is_straight ? v[6] : v[7])) * scale;
  return out;
}

void add_radiance_spot(const RadianceLook& look, const std::string& name,
                       const RadianceExtent& extent, Scene& scene) {
  const double flat = length(extent.area);
  const Vec3d axis = normalize(look.spot_axis);
  const double tilt = flat > 0 ? dot(extent.area / flat, axis) : 1;
  if (!(tilt > 0)) return;
  if (tilt < 0.999)
    scene.warnings.add(
        "\"spotlight\" whose beam is oblique to its surface: its cosine is taken from the beam's "
        "axis instead of the normal");
  Light e;
  e.name = name;
  e.kind = LightKind::point;
  e.radiance = look.emission * float(flat > 0 ? flat * tilt : extent.section);
  e.position = Vec3(extent.middle - scene.origin);
  e.focal_distance = float(length(look.spot_axis));
  const Frame frame{Vec3(axis)};
  e.axes = {frame.tangent, frame.bitangent, frame.normal};
  if (!is_finite(e.position) || !is_finite(e.axes[2]) || !is_finite(e.radiance) ||
      e.radiance.is_black())
    return;
  e.web = int32_t(scene.webs.size());
  scene.webs.push_back(beam(rad_from_deg(look.spot_angle_deg) / 2, flat > 0, name));
  scene.warnings.add("\"spotlight\" is approximated by a point spot at its centre");
  scene.lights.push_back(std::move(e));
}

}  // namespace troffer
