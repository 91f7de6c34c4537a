#include "import/light_radius.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/frame.h"
#include "base/units.h"

namespace troffer {

namespace {

// Returns a spot's falloff as a web relative to its largest intensity. The web depends on the angle
// from the axis alone, with steps that follow the falloff.
LightWeb web_of_spot(const Light& e, float cross_section) {
  LightWeb web;
  web.name = e.name;
  web.horizontal_angles_rad = {0, 2 * pi_f};
  web.cross_section = cross_section;
  const double inner = std::acos(std::clamp(double(e.cos_inner), -1.0, 1.0));
  const double outer = std::acos(std::clamp(double(e.cos_outer), -1.0, 1.0));
  constexpr int steps = 64;
  std::vector<float> shares;
  const auto add = [&](double angle, double share) {
    if (!web.vertical_angles_rad.empty() && !(float(angle) > web.vertical_angles_rad.back()))
      return;
    web.vertical_angles_rad.push_back(float(angle));
    shares.push_back(float(share));
  };
  add(0, 1);
  for (int i = 0; i <= steps; ++i) {
    const double angle = std::lerp(inner, outer, double(i) / steps);
    const double fade = std::clamp(
        (std::cos(angle) - double(e.cos_outer)) / (double(e.cos_inner) - double(e.cos_outer)), 0.0,
        1.0);
    add(angle, e.falloff == SpotFalloff::square ? fade * fade : fade * fade * (3 - 2 * fade));
  }
  if (web.vertical_angles_rad.size() < 2)
    add(std::nextafter(web.vertical_angles_rad.back(), 4.0f), 0);
  for (int turn = 0; turn < 2; ++turn)
    web.intensities.insert(web.intensities.end(), shares.begin(), shares.end());
  return web;
}

}  // namespace

void give_radius(Scene& scene, double radius) {
  const auto cross_section = float(pi * radius * radius);
  uint32_t black = 0;
  bool has_black = false;
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    Light& e = scene.lights[i];
    if (e.kind != LightKind::point && e.kind != LightKind::spot) continue;
    if (e.environment != no_environment || e.texture != no_texture) {
      scene.warnings.add("--light-radius: lights that project images stay points");
      continue;
    }
    if (e.range != 0) scene.warnings.add("--light-radius: the range of lights is ignored");
    e.range = 0;
    if (e.kind == LightKind::spot) {
      e.web = int32_t(scene.webs.size());
      scene.webs.push_back(web_of_spot(e, cross_section));
      const Frame frame(e.direction);
      e.axes = {frame.tangent, frame.bitangent, frame.normal};
    } else if (e.web != no_web) {
      LightWeb own = scene.webs[size_t(e.web)];  // may be shared with other lights
      own.cross_section = cross_section;
      e.web = int32_t(scene.webs.size());
      scene.webs.push_back(std::move(own));
    } else {
      e.radiance *= 1 / cross_section;
    }
    if (!has_black) {
      black = uint32_t(scene.materials.size());
      scene.materials.emplace_back().base_color.value = Rgb{0};
      has_black = true;
    }
    Sphere sphere;
    sphere.centre = e.position;
    sphere.radius = float(radius);
    sphere.material = black;
    sphere.light = int32_t(i);
    e.kind = LightKind::sphere;
    e.geometry = uint32_t(scene.spheres.size());
    scene.spheres.push_back(sphere);
  }
}

}  // namespace troffer
