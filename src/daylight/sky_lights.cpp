#include "daylight/sky_lights.h"

#include <cmath>

#include "base/units.h"
#include "daylight/sky_model.h"

namespace troffer {

namespace {

constexpr double usual_lx = 10'000;  // illuminance of skies without a sun

struct Amounts {
  SkyShape shape;
  double diffuse_lx = usual_lx, direct_lx = 0;
};

Amounts amounts_of(const SkyRequest& request) {
  Amounts a;
  const double altitude = request.sun ? request.sun->altitude_deg : 45;
  const double zenith_rad = rad_from_deg(90 - altitude);
  const double distance = request.sun ? request.sun->distance_au : 1;
  if (request.kind == SkyKind::perez) {
    const PerezSky sky =
        perez_sky(request.direct_normal, request.diffuse_horizontal, zenith_rad, distance);
    a = {sky.shape, sky.diffuse_lx, sky.direct_lx};
  } else if (request.kind == SkyKind::cie) {
    a.shape = cie_sky(request.cie_type);
    if (request.sun) {
      a.diffuse_lx = typical_diffuse_lx(request.cie_type, altitude);
      a.direct_lx = typical_direct_lx(request.cie_type, altitude, distance);
    }
  }
  if (request.turbidity && request.sun) {
    const Irradiance clear = clear_irradiance(*request.turbidity, altitude, distance);
    const PerezSky sky =
        perez_sky(clear.direct_normal, clear.diffuse_horizontal, zenith_rad, distance);
    a.diffuse_lx = sky.diffuse_lx;
    a.direct_lx = sky.direct_lx;
  }
  if (request.diffuse_lx) a.diffuse_lx = *request.diffuse_lx;
  if (request.sun && request.sun->direct_lx) a.direct_lx = *request.sun->direct_lx;
  return a;
}

}  // namespace

Vec3d Compass::direction(double azimuth_deg, double altitude_deg) const {
  const double azimuth = rad_from_deg(azimuth_deg), altitude = rad_from_deg(altitude_deg);
  return (north * std::cos(azimuth) + east * std::sin(azimuth)) * std::cos(altitude) +
         up * std::sin(altitude);
}

Compass make_compass(const Vec3& up, double north_deg, bool is_mirrored) {
  Compass c;
  c.up = normalize(Vec3d(up));
  const Vec3d start = std::abs(c.up.z) > 0.7 ? Vec3d{0, 1, 0} : Vec3d{0, 0, -1};
  const Vec3d ahead = normalize(start - c.up * dot(start, c.up));
  const Vec3d right = cross(ahead, c.up) * (is_mirrored ? -1 : 1);
  const double turn = rad_from_deg(north_deg);
  c.north = ahead * std::cos(turn) + right * std::sin(turn);
  c.east = right * std::cos(turn) - ahead * std::sin(turn);
  return c;
}

bool needs_sun(const SkyRequest& request) {
  if (request.kind == SkyKind::perez) return true;
  return request.kind == SkyKind::cie && cie_sky(request.cie_type).c > 0;
}

void add_sky(Scene& scene, const SkyRequest& request, const Compass& compass) {
  const Amounts a = amounts_of(request);
  const double unit = scene.is_photometric ? 1 : 1 / luminous_efficacy;
  const double altitude = request.sun ? request.sun->altitude_deg : 45;
  const Vec3d to_sun =
      request.sun ? compass.direction(request.sun->azimuth_deg, altitude) : compass.up;
  const double zenith_rad = request.sun ? rad_from_deg(90 - altitude) : 0;

  Light sky;
  sky.name = "sky";
  sky.kind = LightKind::sky;
  sky.sky = a.shape;
  sky.direction = Vec3(-to_sun);
  sky.axes = {Vec3(compass.east), Vec3(compass.north), Vec3(compass.up)};
  sky.radiance = Rgb{float(a.diffuse_lx * unit / horizontal_integral(a.shape, zenith_rad))};
  const double global_lx = a.diffuse_lx + a.direct_lx * std::max(0.0, dot(to_sun, compass.up));
  sky.sky.ground = Rgb{float(request.ground_reflectance * global_lx * unit / pi)};
  if (emits(sky)) scene.lights.push_back(sky);

  if (!request.sun || !(a.direct_lx > 0)) return;
  Light sun;
  sun.name = "sun";
  sun.kind = LightKind::sun;
  sun.direction = Vec3(-to_sun);
  sun.angular_radius = float(rad_from_deg(sun_angular_radius_deg) / request.sun->distance_au);
  // Disc of angular radius r about the normal: irradiance pi L sin² r.
  const double sine = std::sin(double(sun.angular_radius));
  sun.radiance = Rgb{float(a.direct_lx * unit / (pi * sine * sine))};
  scene.lights.push_back(sun);
}

void add_environment(Scene& scene, EnvironmentMap map, double scale, double rotation_deg,
                     const Compass& compass) {
  Light e;
  e.name = "environment";
  e.kind = LightKind::environment;
  e.radiance = Rgb{float(scale)};
  e.environment = int32_t(scene.environments.size());
  const double turn = rad_from_deg(rotation_deg);
  const Vec3d ahead = compass.east * std::cos(turn) - compass.north * std::sin(turn);
  const Vec3d left = compass.north * std::cos(turn) + compass.east * std::sin(turn);
  // Azimuths of an image grow to the right, so its middle is at half a turn.
  if (map.projection == SphereMap::lat_long)
    e.axes = {Vec3(-ahead), Vec3(left), Vec3(compass.up)};
  else
    e.axes = {Vec3(ahead), Vec3(left), Vec3(compass.up)};
  scene.environments.push_back(std::move(map));
  scene.lights.push_back(std::move(e));
}

}  // namespace troffer
