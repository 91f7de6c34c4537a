#include "import/radiance/radiance_sky.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/units.h"

namespace troffer {

namespace {

constexpr double widest_sun_deg = 60;
constexpr int map_height = 512;

bool set_axes(Light& e, const Vec3d& up) {
  const Vec3d x = normalize(cross(std::abs(up.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0}, up));
  e.axes = {Vec3(x), Vec3(cross(up, x)), Vec3(up)};
  return is_finite(e.axes[0]) && is_finite(e.axes[2]);
}

// Image of the light within a cone about the map's z axis: the pattern at each texel's centre, or
// 1. Rows on the rim are weighted by the share of their solid angle in the cone.
EnvironmentMap cone_map(RadiancePattern* pattern, double half_angle, const Light& e) {
  EnvironmentMap map;
  map.name = e.name;
  map.height = map_height;
  map.width = 2 * map_height;
  map.texels.resize(size_t(map.width) * size_t(map.height));
  parallel_pieces(map_height, 32, [&](size_t begin, size_t end) {
    RadiancePattern own;
    if (pattern != nullptr) own = *pattern;  // evaluation changes the pattern
    for (size_t y = begin; y < end; ++y) {
      const double top = std::cos(pi * double(y) / map_height),
                   bottom = std::cos(pi * double(y + 1) / map_height);
      const double part = std::clamp((top - std::cos(half_angle)) / (top - bottom), 0.0, 1.0);
      if (half_angle < pi && part <= 0) break;
      for (size_t x = 0; x < size_t(map.width); ++x) {
        const Vec3 w = lat_long_direction(
            {(float(x) + 0.5f) / float(map.width), (float(y) + 0.5f) / float(map_height)});
        const Vec3d world = Vec3d(e.axes[0]) * double(w.x) + Vec3d(e.axes[1]) * double(w.y) +
                            Vec3d(e.axes[2]) * double(w.z);
        const Rgb value = own.value({world, -world, {}});
        map.texels[y * size_t(map.width) + x] = value * float(half_angle < pi ? part : 1);
      }
    }
  });
  return map;
}

}  // namespace

bool add_radiance_source(const RadianceLook& look, RadiancePattern* pattern, const Vec3d& to,
                         double angle_deg, const std::string& name, Scene& scene) {
  Light e;
  e.name = name;
  e.radiance = look.emission;
  e.direction = Vec3(-to);
  if (pattern != nullptr) {
    const Vec3d a{e.axes[0]}, b{e.axes[1]}, c{e.axes[2]};
    std::vector<Vec3d> around{to};
    for (const Vec3d& side : {a, b, c, -a, -b, -c}) around.push_back(normalize(to + side * 0.5));
    pattern->check(around);
  }
  const bool is_sphere = angle_deg > 359.99, is_hemisphere = std::abs(angle_deg - 180) < 0.01;
  if (angle_deg <= widest_sun_deg) {
    e.kind = LightKind::sun;
    e.angular_radius = float(rad_from_deg(std::max(angle_deg, 1e-3) / 2));
    if (pattern != nullptr) e.radiance *= pattern->value({to, -to, {}});
  } else if (pattern == nullptr && is_sphere) {
    e.kind = LightKind::environment;
  } else if (pattern == nullptr && is_hemisphere) {
    e.kind = LightKind::sky;
    if (!set_axes(e, to)) return false;
  } else {
    e.kind = LightKind::environment;
    if (!set_axes(e, to)) return false;
    EnvironmentMap map = cone_map(pattern, rad_from_deg(angle_deg) / 2, e);
    const bool is_dark = std::all_of(map.texels.begin(), map.texels.end(),
                                     [](const Rgb& t) { return t.is_black(); });
    if (is_dark) return true;  // a sky of gendaylit with the sun below the horizon
    e.environment = int32_t(scene.environments.size());
    scene.environments.push_back(std::move(map));
  }
  if (!is_finite(e.radiance) || e.radiance.is_black()) return false;
  scene.lights.push_back(std::move(e));
  return true;
}

}  // namespace troffer
