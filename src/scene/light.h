// Lights as data: one closed set of kinds. Importers fill them in; light/light.h implements each
// kind. Units are W/(m² sr) and W/sr, or cd/m² and cd if Scene::is_photometric.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/rgb.h"
#include "base/vec.h"
#include "scene/material.h"

namespace troffer {

constexpr int32_t no_light = -1;
constexpr int32_t no_environment = -1;
constexpr int32_t no_web = -1;

enum class LightKind : uint8_t {
  // Diffuse surfaces. Hits carry their index (Mesh::lights, Sphere::light, Disk::light).
  polygon,
  disk,
  sphere,
  mesh,
  // No surface: no ray hits them.
  point,
  spot,
  // At infinity: rays that leave the scene see them, except `distant`.
  distant,
  environment,
  sky,
  sun,
};

// Relative luminance of a sky: (1 + a exp(b / cos Z)) (k + c exp(d x) + e cos² x), at the angle Z
// from the zenith and x from the sun (light/sky_light.h). Below the horizon it is the ground's.
struct SkyShape {
  float a = 0, b = 0, c = 0, d = 0, e = 0, k = 1;
  Rgb ground;  // radiance
};

// Falloff of a spot between its angles; t is 0 at the outer cosine and 1 at the inner one.
enum class SpotFalloff : uint8_t {
  smooth_step,  // 3t² - 2t³
  square,       // t²
  linear,       // linear in the angle, not in its cosine (Mitsuba)
};

struct Light {
  std::string name;  // glTF node, otherwise emitter0, emitter1 and so on; may repeat
  LightKind kind = LightKind::polygon;
  // Radiance in W/(m² sr), or cd/m² if Scene::is_photometric. Point, spot: largest radiant
  // intensity, W/sr or cd. Distant: irradiance of a surface that faces it, W/m² or lx. An
  // environment's image, a sky's shape and a web are multiplied by it.
  Rgb radiance;

  // Kinds with a surface emit from the front, or from both sides if is_two_sided. The texture is a
  // factor on radiance: of a mesh over its (u,v), of a point or spot a projected picture
  // (scene/projected_image.h).
  int32_t texture = no_texture;
  bool is_two_sided = false;
  bool is_alpha_masked = false;     // mesh only: the material's mask also cuts the emission
  uint32_t geometry = 0;            // index into meshes, disks or spheres
  std::vector<uint32_t> triangles;  // polygon, mesh: triangles of that mesh, ascending
  std::vector<Vec3> polygon;        // polygon: convex outline, counterclockwise from the front

  // environment, sky, sun: corners of the portal rectangle, counterclockwise as seen from the side
  // that its light reaches. Empty without portal.
  std::vector<Vec3> portal;

  Vec3 position;  // point, spot
  // spot: beam axis. distant, sun: direction that the light travels in; sky: the same for its sun.
  // Unit.
  Vec3 direction{0, 0, -1};
  // spot: full intensity within the inner angle, none beyond the outer one, which is larger
  float cos_inner = 1, cos_outer = 0;
  SpotFalloff falloff = SpotFalloff::smooth_step;
  // point with a texture: irradiance on a plane across the axis is proportional to the picture.
  // The intensity at angle a from the axis is divided by cos³ a (Mitsuba's projector).
  bool has_uniform_plane = false;
  // point, spot, m: distance where the light has faded to nothing; 0: no limit
  // (light/no_surface.h).
  float range = 0;
  // point, spot, m: the light falls off as if it stood this far behind its position (Radiance's
  // spotlight).
  float focal_distance = 0;

  int32_t environment = no_environment;  // environment, point: index into Scene::environments
  SkyShape sky;                          // sky
  float angular_radius = 0;              // sun: of its disc, rad
  // point, kinds with a surface: index into Scene::webs
  int32_t web = no_web;
  // World directions of the light's own x, y, z: unit, orthogonal, of either handedness. They
  // orient an environment's image, a sky (z is up), and the luminaire of a web. The x and y axes of
  // a projected picture are not unit (scene/projected_image.h).
  std::array<Vec3, 3> axes{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
};

inline bool has_surface(LightKind k) {
  return k <= LightKind::mesh;
}

// True if the light reaches a point from a single direction, which no sampled ray hits.
inline bool is_delta(LightKind k) {
  return k == LightKind::point || k == LightKind::spot || k == LightKind::distant;
}

// True if the light emits anything. A sky without diffuse light can still have a lit ground.
inline bool emits(const Light& e) {
  return !e.radiance.is_black() || (e.kind == LightKind::sky && !e.sky.ground.is_black());
}

// Calls visit(v) for the numbers, vectors and colours that define a light. Leaves out its name and
// its triangle list, which Mesh::lights holds too.
template <class Visit>
void for_each_value(const Light& e, const Visit& visit) {
  visit(uint64_t(e.kind) | uint64_t(e.is_two_sided) << 8 | uint64_t(e.has_uniform_plane) << 9);
  visit(e.radiance);
  visit(uint64_t(e.texture));
  visit(uint64_t(e.geometry));
  for (const Vec3& p : e.polygon) visit(p);
  if (has_surface(e.kind)) return;
  visit(e.position);
  visit(e.direction);
  visit(e.cos_inner);
  visit(e.cos_outer);
  visit(uint64_t(e.falloff));
  visit(e.range);
  visit(e.focal_distance);
  visit(uint64_t(e.environment));
  for (const float f : {e.sky.a, e.sky.b, e.sky.c, e.sky.d, e.sky.e, e.sky.k}) visit(f);
  visit(e.sky.ground);
  visit(e.angular_radius);
  for (const Vec3& p : e.portal) visit(p);
  visit(uint64_t(e.web));
  for (const Vec3& axis : e.axes) visit(axis);
}

inline const char* name_of(LightKind k) {
  switch (k) {
    case LightKind::polygon:
      return "polygon";
    case LightKind::disk:
      return "disk";
    case LightKind::sphere:
      return "sphere";
    case LightKind::mesh:
      return "mesh";
    case LightKind::point:
      return "point";
    case LightKind::spot:
      return "spot";
    case LightKind::distant:
      return "distant";
    case LightKind::environment:
      return "environment";
    case LightKind::sky:
      return "sky";
    case LightKind::sun:
      return "sun";
  }
  return "";
}

}  // namespace troffer
