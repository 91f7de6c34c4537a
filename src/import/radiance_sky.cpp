#include "import/radiance_sky.h"

#include <cmath>

#include "base/units.h"

namespace troffer {

namespace {

// Wider ones are skies.
constexpr double widest_sun_deg = 60, narrowest_sky_deg = 170;

bool set_axes(Light& e, const Vec3d& up) {
  const Vec3d x = normalize(cross(std::abs(up.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0}, up));
  e.axes = {Vec3(x), Vec3(cross(up, x)), Vec3(up)};
  return is_finite(e.axes[0]) && is_finite(e.axes[2]);
}

// The pattern of gensky's output: A1 kind of sky, A2 brightness of the zenith, A3 of the ground, A4
// the clear sky's factor, A5-A7 towards the sun [1]. False: nothing of it is in this hemisphere.
bool set_pattern(const RadianceModifier& pattern, const Vec3d& to, const Affine& world, Light& e,
                 WarningLog& warnings) {
  const auto& a = pattern.arguments.reals;
  const auto kind = int(std::clamp(a[0], -10.0, 10.0));
  const Vec3d zenith = normalize(world.vector({0, 0, 1}));
  if (dot(to, zenith) < 0) {  // the ground: even
    e.radiance *= float(std::max(a[2], 0.0));
    return true;
  }
  const Vec3d to_sun = normalize(world.vector({a[4], a[5], a[6]}));
  if (is_finite(to_sun)) e.direction = Vec3(-to_sun);
  double scale = a[1];
  if (kind == 1 || kind == 4) {
    // (0.91 + 10 exp(-3 x) + 0.45 cos² x) (1 - exp(-0.32 / cos Z)) / A4
    e.sky = {-1, -0.32f, 10, -3, 0.45f, 0.91f, {}};
    if (!(a[3] > 0) || !is_finite(to_sun)) return false;
    scale /= a[3];
    if (kind == 4) warnings.add("skybright's intermediate sky is shown as its clear one");
  } else if (kind == 2) {
    // (1 + 2 cos Z) / 3, by the CIE's own formula of that sky [2], equal at the zenith
    e.sky = {4, -0.7f, 0, -1, 0, 1, {}};
    scale /= 1 + 4 * std::exp(-0.7);
  } else if (kind != 3) {
    warnings.add("skybright's sky of that kind is shown even");
  }
  e.radiance *= float(std::max(scale, 0.0));
  return true;
}

}  // namespace

bool add_radiance_source(const RadianceLook& look, const Vec3d& to, double angle_deg,
                         const Affine& world, const std::string& name, Scene& scene) {
  Light e;
  e.name = name;
  e.radiance = look.emission;
  e.direction = Vec3(-to);
  if (angle_deg > 270 && !look.sky) {
    e.kind = LightKind::environment;
  } else if (angle_deg <= widest_sun_deg) {
    e.kind = LightKind::sun;
    e.angular_radius = float(rad_from_deg(std::max(angle_deg, 1e-3) / 2));
  } else {
    e.kind = LightKind::sky;
    if (!set_axes(e, to)) return false;
    if (angle_deg < narrowest_sky_deg) {
      e.radiance *= float(sqr(std::sin(rad_from_deg(angle_deg) / 2)));
      scene.warnings.add("source '" + shortened(name) +
                         "' is spread over a hemisphere, with the same light on what faces it");
    }
    if (look.sky && !set_pattern(*look.sky, to, world, e, scene.warnings)) return false;
  }
  if (!is_finite(e.radiance) || e.radiance.is_black()) return false;
  scene.lights.push_back(std::move(e));
  return true;
}

}  // namespace troffer
