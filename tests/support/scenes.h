// Small scenes with known light, built in memory.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace troffer::test {

inline uint32_t add_material(Scene& s, Material m) {
  s.materials.push_back(std::move(m));
  return uint32_t(s.materials.size() - 1);
}

inline uint32_t add_diffuse(Scene& s, Rgb reflectance) {
  Material m;
  m.kind = MaterialKind::diffuse;
  m.base_color.value = reflectance;
  return add_material(s, m);
}

// Adds a quadrilateral, whose front follows from the order of its corners; returns its mesh index.
inline uint32_t add_quad(Scene& s, uint32_t material, const std::array<Vec3, 4>& corners) {
  Mesh m;
  m.positions.assign(corners.begin(), corners.end());
  m.triangles = {{0, 1, 2}, {0, 2, 3}};
  m.material = material;
  s.meshes.push_back(std::move(m));
  return uint32_t(s.meshes.size() - 1);
}

// Adds an opaque sheet with an alpha mask. Facet lists leave such occluders to rays.
inline void add_leaf(Scene& s, const std::array<Vec3, 4>& corners) {
  Material m;
  m.is_alpha_masked = true;
  const uint32_t masked = add_material(s, m);
  add_quad(s, masked, corners);
}

// Turns a quad into a polygon source.
inline void make_light(Scene& s, uint32_t mesh, Rgb radiance, bool is_two_sided = false) {
  Light e;
  e.name = "emitter" + std::to_string(s.lights.size());
  e.radiance = radiance;
  e.is_two_sided = is_two_sided;
  e.geometry = mesh;
  e.triangles = {0, 1};
  e.polygon = s.meshes[mesh].positions;
  s.meshes[mesh].lights.assign(2, int32_t(s.lights.size()));
  s.lights.push_back(std::move(e));
}

// Adds the inside of the box [a, b]: six quads facing inwards (floor, ceiling, four walls).
inline std::array<uint32_t, 6> add_box_inside(Scene& s, uint32_t material, const Vec3& a,
                                              const Vec3& b) {
  return {add_quad(s, material,
                   {Vec3{a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {a.x, b.y, a.z}}),
          add_quad(s, material,
                   {Vec3{a.x, a.y, b.z}, {a.x, b.y, b.z}, {b.x, b.y, b.z}, {b.x, a.y, b.z}}),
          add_quad(s, material,
                   {Vec3{a.x, a.y, a.z}, {a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, a.y, a.z}}),
          add_quad(s, material,
                   {Vec3{a.x, b.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z}}),
          add_quad(s, material,
                   {Vec3{a.x, a.y, a.z}, {a.x, b.y, a.z}, {a.x, b.y, b.z}, {a.x, a.y, b.z}}),
          add_quad(s, material,
                   {Vec3{b.x, a.y, a.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {b.x, b.y, a.z}})};
}

// Adds a w × w source at height h over the origin, facing down.
inline void add_ceiling_light(Scene& s, float w, float h, Rgb radiance) {
  const uint32_t black = add_diffuse(s, Rgb{0});
  const float r = w / 2;
  const uint32_t quad = add_quad(s, black, {Vec3{-r, -r, h}, {-r, r, h}, {r, r, h}, {r, -r, h}});
  make_light(s, quad, radiance);
}

}  // namespace troffer::test
