// Surface properties at a hit, and safe ray origins. Integrators call surface_at for each hit.
// Lengths in metres.
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

// The surface at a hit. Normals point to the front.
struct Surface {
  Vec3 position;                         // from barycentrics, accurate to a few ulps
  Vec3 geometric_normal;                 // unit, on the front
  Vec3 shading_normal;                   // unit, on the front; interpolated and mapped
  TexturePlace uv;                       // with the footprint of the ray
  float offset = 0;                      // metres: exceeds the rounding error of position
  uint32_t geometry = 0, primitive = 0;  // as in Hit
  uint32_t material = 0;
  int32_t light = no_light;
};

Surface surface_at(const Scene& scene, const Ray& ray, const Hit& hit);
// Does the same in place and writes every member. cone: of a ray with unit direction.
void surface_at(const Scene& scene, const Ray& ray, const Hit& hit, Surface& out,
                const RayCone& cone = {});

// Prefetches the memory of the base colour texture, if any.
inline void prefetch_color(const Scene& scene, const Surface& s) {
  const int32_t texture = scene.materials[s.material].base_color.texture;
  if (texture >= 0) prefetch(scene.textures, uint32_t(texture), s.uv);
}

// Returns the origin of a new ray in direction `towards`, clear of the surface.
inline Vec3 offset_origin(const Surface& s, const Vec3& towards) {
  const float side = dot(s.geometric_normal, towards) < 0 ? -s.offset : s.offset;
  return s.position + s.geometric_normal * side;
}

// Returns the offset of rays from a surface with coordinates up to `magnitude` metres. It is about
// 32 ulps, which covers the rounding of hit points and of Embree's intersections [1].
constexpr float ray_offset(float magnitude) {
  return 4e-6f * magnitude;
}

// Shortens a vector to a point of a light so that it ends `off` metres above the light's plane, and
// the light does not hide itself. normal: of the light, unit, on this side; zero for lights without
// extent. The direction stays: moving the end along the normal could look past an edge
// (docs/log/trace.md).
inline Vec3 ended_before_light(const Vec3& way, const Vec3& normal, float off) {
  const float height = std::max(-dot(way, normal), 2 * off);
  return way * (1 - dot(normal, normal) * off / std::max(height, 1e-30f));
}

}  // namespace troffer
