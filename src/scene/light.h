// What the scene says gives light: one closed set of kinds, plain data. What each kind does is in
// light/light.h.
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
  // Diffuse surfaces; what is hit has their number (Mesh::lights, Sphere::light, Disk::light).
  polygon,
  disk,
  sphere,
  mesh,
  // Without surface: no ray hits them.
  point,
  spot,
  // At infinity: rays that leave the scene see them, but for `distant`.
  distant,
  environment,
  sky,
  sun,
};

// Luminance of a sky, relative: (1 + a exp(b / cos Z)) (k + c exp(d x) + e cos² x) at the angle Z
// from the zenith and x from the sun (light/sky_light.h); below the horizon the ground.
struct SkyShape {
  float a = 0, b = 0, c = 0, d = 0, e = 0, k = 1;
  Rgb ground;  // radiance
};

// How a spot fades between its angles, by t = 0 at the outer cosine to 1 at the inner one.
enum class SpotFalloff : uint8_t {
  smooth_step,  // 3t² - 2t³
  square,       // t²
  linear,       // by the angle itself, not its cosine: Mitsuba's
};

struct Light {
  std::string name;  // glTF node, else emitter0, emitter1 …; may repeat
  LightKind kind = LightKind::polygon;
  // W/(m² sr), or cd/m² where Scene::is_photometric; point, spot: radiant intensity (largest), W/sr
  // or cd; distant: irradiance of a surface that faces it, W/m² or lx. A factor on what varies: an
  // environment's image, a sky's shape, a web.
  Rgb radiance;

  // Kinds with a surface: it emits from the front, or from both sides where is_two_sided.
  // Factor on radiance: of a mesh over its (u,v); of a point or a spot a picture that it throws
  // (scene/projected_image.h).
  int32_t texture = no_texture;
  bool is_two_sided = false;
  bool is_alpha_masked = false;     // mesh only: dark where its material's mask makes holes
  uint32_t geometry = 0;            // index into meshes, disks or spheres
  std::vector<uint32_t> triangles;  // polygon, mesh: the triangles of that mesh, ascending
  std::vector<Vec3> polygon;        // polygon: convex outline, counterclockwise seen from front

  // environment, sky, sun: nothing, or the corners of a rectangle that its light comes through
  // alone, counterclockwise seen from where it arrives
  std::vector<Vec3> portal;

  Vec3 position;  // point, spot
  // spot: axis of its beam; distant, sun, sky: which the light takes that comes from there, or from
  // the sun in it; unit
  Vec3 direction{0, 0, -1};
  // spot: whole within the inner angle, none beyond the outer one, which is larger
  float cos_inner = 1, cos_outer = 0;
  SpotFalloff falloff = SpotFalloff::smooth_step;
  // point with a texture: a plane across its axis gets light in proportion to the picture, so that
  // the intensity at the angle a from the axis is over cos³ a (Mitsuba's projector)
  bool lights_plane_evenly = false;
  float range = 0;  // point, spot: > 0: fades to nothing at that distance, m (light/point_light.h)

  int32_t environment = no_environment;  // environment: an image, of Scene::environments
  SkyShape sky;                          // sky
  float angular_radius = 0;              // sun: of its disc, rad
  // point, kinds with a surface: how it shines by direction, of Scene::webs
  int32_t web = no_web;
  // World directions of its own x, y, z, unit, orthogonal, of any handedness: of the environment's
  // image; sky: z is up; of the luminaire whose web it has
  std::array<Vec3, 3> axes{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
};

inline bool has_surface(LightKind k) {
  return k <= LightKind::mesh;
}

// A single direction brings its light to a point: none meets it by chance.
inline bool is_delta(LightKind k) {
  return k == LightKind::point || k == LightKind::spot || k == LightKind::distant;
}

// Calls visit(v) with all that says what a light is, but its name and the list of its triangles
// (which Mesh::lights says too): numbers, vectors and colours.
template <class Visit>
void for_each_value(const Light& e, const Visit& visit) {
  visit(uint64_t(e.kind) | uint64_t(e.is_two_sided) << 8 | uint64_t(e.lights_plane_evenly) << 9);
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
