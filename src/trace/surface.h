// The surface at a hit.
// References: [1] Pharr, Jakob & Humphreys, "Physically Based Rendering", 4th ed., §6.8 (rounding
// error of intersections).
#pragma once

#include <algorithm>
#include <cstdint>

#include "base/frame.h"
#include "scene/scene.h"
#include "scene/texture.h"
#include "trace/ray.h"

namespace troffer {

struct Surface {
  Vec3 position;                         // from barycentrics, accurate to a few ulps
  Vec3 geometric_normal;                 // unit, on the front
  Vec3 shading_normal;                   // unit, on the front; interpolated and normal-mapped
  TexturePlace uv;                       // with what the ray stands for
  float offset = 0;                      // metres: farther from the surface than rounding can err
  uint32_t geometry = 0, primitive = 0;  // as in Hit
  uint32_t material = 0;
  int32_t light = no_light;
};

Surface surface_at(const Scene& scene, const Ray& ray, const Hit& hit);
// The same in place, every member written. cone: of a ray whose direction is unit.
void surface_at(const Scene& scene, const Ray& ray, const Hit& hit, Surface& out,
                const RayCone& cone = {});

// Asks for the memory of the texture, if any, that colours the surface (prefetch()).
inline void prefetch_color(const Scene& scene, const Surface& s) {
  const int32_t texture = scene.materials[s.material].base_color.texture;
  if (texture >= 0) prefetch(scene.textures, uint32_t(texture), s.uv);
}

// Where a new ray in the direction of `towards` starts, clear of the surface it leaves.
inline Vec3 offset_origin(const Surface& s, const Vec3& towards) {
  const float side = dot(s.geometric_normal, towards) < 0 ? -s.offset : s.offset;
  return s.position + s.geometric_normal * side;
}

// How far rays must start from a surface whose coordinates reach `magnitude` metres: some 32 ulps,
// which covers the rounding of hit points and of Embree's intersections [1].
constexpr float ray_offset(float magnitude) {
  return 4e-6f * magnitude;
}

// A way to a point of a light, made to end just before it, so that the light itself does not count:
// shortened, not turned, until it ends `off` metres above the light's plane. `normal`: of the
// light, unit, on this side; zero if the light is without extent. An end moved along the normal
// would see over an edge what the point does not: 50 µm off a strip behind a low edge were 12 % of
// the light where 1 mm of the strip is seen.
inline Vec3 ended_before_light(const Vec3& way, const Vec3& normal, float off) {
  const float height = std::max(-dot(way, normal), 2 * off);
  return way * (1 - dot(normal, normal) * off / std::max(height, 1e-30f));
}

}  // namespace troffer
