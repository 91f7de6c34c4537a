// Scene: adds lights without a surface, skies, environment images and luminaires.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "api/scene_impl.h"
#include "api/script_words.h"
#include "api/values.h"
#include "base/error.h"
#include "base/units.h"
#include "image/image.h"
#include "import/luminaire/attach_luminaire.h"
#include "lighting/attached_luminaires.h"
#include "scene/orientation.h"
#include "troffer/scene.h"

namespace troffer::api {

namespace {

constexpr size_t most_environment_texels = size_t(8) << 20;

void add_lamp(ScriptScene& scene, Light&& light) {
  scene.append([&] {
    scene.change().lights.push_back(std::move(light));
    scene.note_new_lights();
  });
}

SkyRequest sky_request(const Sky& sky) {
  SkyRequest r;
  r.kind = sky.kind == "even" ? SkyKind::even : SkyKind::cie;
  r.cie_type = sky.kind == "overcast" ? 1 : sky.kind == "clear" ? 12 : 0;
  for (int type = 1; type <= 15; ++type)
    if (sky.kind == "cie:" + std::to_string(type)) r.cie_type = type;
  if (r.kind == SkyKind::cie && r.cie_type == 0)
    throw UsageError("a sky is even, overcast, clear or cie:1 to cie:15");
  if (sky.lux) r.diffuse_lx = in_range(*sky.lux, 0, 1e9, "lux");
  if (sky.sun) {
    r.sun = SunRequest{};
    if (!std::isfinite(sky.sun->first)) throw UsageError("the sun's azimuth is a finite number");
    r.sun->azimuth_deg = sky.sun->first;
    r.sun->altitude_deg = in_range(sky.sun->second, 0, 90, "the sun's altitude");
  } else if (needs_sun(r)) {
    throw UsageError("this sky depends on the sun: sun=(azimuth, altitude)");
  }
  r.ground_reflectance = in_range(sky.ground, 0, 1, "ground");
  return r;
}

DaylightOptions daylight_options(const AddedLight& light) {
  DaylightOptions o;
  o.luminaires = light.luminaires;
  o.luminaire_list = light.luminaire_list;
  o.sky = light.sky;
  o.sun = light.sun;
  o.at = light.at;
  o.weather = light.weather;
  o.date = light.date;
  o.environment = light.environment;
  o.portals = light.portals;
  o.up = light.up;
  o.turbidity = light.turbidity;
  o.north_deg = light.north;
  o.ground = light.ground;
  o.environment_rotation_deg = light.environment_rotation;
  o.light_radius = light.light_radius;
  // Without a request for a sky, a dark scene stays dark.
  if (o.sky.empty() && o.sun.empty() && o.at.empty() && o.weather.empty()) o.sky = "none";
  return o;
}

// Returns a direction in half-plane C0: the part of the scene's x axis that is perpendicular to the
// nadir, turned about the nadir. If the nadir lies along x, starts from the y axis.
Vec3d luminaire_axis(const Vec3d& nadir, double rotation_deg) {
  const Vec3d x = std::abs(nadir.x) < 0.999 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d u = normalize(x - nadir * dot(x, nadir)), v = cross(nadir, u);
  const double turn = rad_from_deg(rotation_deg);
  return u * std::cos(turn) + v * std::sin(turn);
}

}  // namespace

void Scene::add_light(const PointLight& light) {
  ScriptScene& s = impl_->script;
  Light e;
  e.name = light.name;
  e.kind = LightKind::point;
  e.radiance = emitted(light.intensity, "intensity");
  e.position = Vec3(place(light.position, "position") - s.scene().origin);
  add_lamp(s, std::move(e));
}

void Scene::add_light(const SpotLight& light) {
  ScriptScene& s = impl_->script;
  Light e;
  e.name = light.name;
  e.kind = LightKind::spot;
  e.radiance = emitted(light.intensity, "intensity");
  e.position = Vec3(place(light.position, "position") - s.scene().origin);
  e.direction = Vec3(direction(light.direction, "direction"));
  const double outer = in_range(light.outer_degrees, 0.01, 90, "outer_degrees");
  const double inner = in_range(light.inner_degrees, 0, outer, "inner_degrees");
  e.cos_outer = float(std::cos(rad_from_deg(outer)));
  e.cos_inner = std::max(float(std::cos(rad_from_deg(inner))), std::nextafter(e.cos_outer, 2.0f));
  e.falloff = SpotFalloff::square;  // glTF's
  add_lamp(s, std::move(e));
}

void Scene::add_light(const DistantLight& light) {
  Light e;
  e.name = light.name;
  e.kind = LightKind::distant;
  e.radiance = emitted(light.irradiance, "irradiance");
  e.direction = Vec3(direction(light.direction, "direction"));
  add_lamp(impl_->script, std::move(e));
}

void Scene::add_light(const Luminaire& light) {
  ScriptScene& s = impl_->script;
  const Vec3d down(-s.up());
  const Vec3d middle = place(light.position, "position");
  const Vec3d nadir = light.nadir ? direction(*light.nadir, "nadir") : normalize(down);
  if (!std::isfinite(light.rotation)) throw UsageError("rotation is a finite number");
  const double dimming = in_range(light.dimming, 0, 1e6, "dimming");
  const double lumens = light.lumens ? in_range(*light.lumens, 1e-6, 1e9, "lumens") : 0;
  const double kelvin = light.kelvin ? in_range(*light.kelvin, 1000, 40'000, "kelvin") : 0;
  WarningLog warnings;
  const troffer::Luminaire read = read_and_check_luminaire(light.file, warnings);
  const Rgb scale = luminaire_scale(s.scene(), read, light.file, lumens, kelvin) * float(dimming);
  s.append([&] {
    troffer::Scene& scene = s.change();
    for (const Warning& w : warnings.entries()) scene.warnings.add(w.text, w.count);
    add_luminaire(scene, light.name, read, add_web(scene, read), scale,
                  {middle - scene.origin, nadir, luminaire_axis(nadir, light.rotation), down});
    s.note_new_lights();
  });
}

void Scene::add_light(const Sky& sky) {
  if (!std::isfinite(sky.north)) throw UsageError("north is a finite number");
  impl_->script.add_sky(sky_request(sky), sky.north);
}

void Scene::add_light(const AddedLight& light) {
  with_script_words([&] { impl_->script.add_light(daylight_options(light)); });
}

void Scene::add_environment(const Image& image, double scale, double rotation) {
  const troffer::Image checked = image_of(image);
  if (checked.pixels.size() > most_environment_texels)
    throw UsageError("an image of the surroundings has at most 8388608 pixels");
  const bool is_light = std::all_of(checked.pixels.begin(), checked.pixels.end(), [](Rgb c) {
    return is_finite(c) && std::min({c.r, c.g, c.b}) >= 0;
  });
  if (!is_light) throw UsageError("surroundings are finite numbers, at least 0");
  in_range(scale, 0, 1e9, "scale");
  if (!std::isfinite(rotation)) throw UsageError("rotation is a finite number");
  ScriptScene& s = impl_->script;
  const Compass compass = make_compass(s.up(), 0, is_mirrored(s.scene()));
  EnvironmentMap map;
  map.name = "environment";
  map.width = checked.width;
  map.height = checked.height;
  map.texels = checked.pixels;
  s.append([&] {
    troffer::add_environment(s.change(), std::move(map), scale, rotation, compass);
    s.note_new_lights();
  });
}

}  // namespace troffer::api
