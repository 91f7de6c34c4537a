// Scenes with instances, and equivalent scenes with copies of the meshes.
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "base/units.h"
#include "scene/mesh_in_world.h"
#include "support/scenes.h"

namespace troffer::test {

inline void add_instance(Scene& s, uint32_t mesh, const Affine& world_from_mesh,
                         const std::string& name = "") {
  const Mesh& m = s.instanced_meshes[mesh];
  s.instances.push_back(
      make_instance(mesh, world_from_mesh, name, reach_of(m), bounds_in_world(m, world_from_mesh)));
}

// Returns a dented ball of radius about 1 with smooth normals and (u,v). No two of its triangles
// are coplanar. It is open if has_lids is false.
inline Mesh dented_ball(uint32_t material, int around = 12, bool has_lids = true) {
  Mesh m;
  m.material = material;
  const int down = around / 2;
  const auto point = [&](int i, int j) {
    const double phi = 2 * pi * (i % around) / around, theta = pi * j / down;
    const double r =
        1 + 0.13 * std::sin(3 * phi + 1) * std::sin(2 * theta) + 0.07 * std::cos(theta);
    return Vec3(
        Vec3d{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)} *
        r);
  };
  const auto number = [&](int i, int j) {
    return uint32_t(j == 0 ? 0 : j == down ? 1 : 2 + (j - 1) * around + i % around);
  };
  m.positions.resize(size_t(2 + (down - 1) * around));
  for (int j = 0; j <= down; ++j)
    for (int i = 0; i < around; ++i) m.positions[number(i, j)] = point(j % down == 0 ? 0 : i, j);
  for (const Vec3& p : m.positions) {
    m.normals.push_back(normalize(p));
    m.uvs.push_back({p.x + 0.3f * p.z, p.y});
  }
  for (int j = 0; j < down; ++j)
    for (int i = 0; i < around; ++i) {
      const uint32_t a = number(i, j), b = number(i, j + 1), c = number(i + 1, j + 1),
                     d = number(i + 1, j);
      if (j > 0 && (has_lids || j + 1 < down)) m.triangles.push_back({a, b, d});
      if (j + 1 < down && (has_lids || j > 0)) m.triangles.push_back({b, c, d});
    }
  return m;
}

// Returns transforms that rotate, stretch, mirror and scale; the instances lie within [-1.6, 1.6]²
// x [.1, 1.6].
inline std::vector<Affine> places_in_room() {
  const auto at = [](double x, double y, double z) { return Affine::translate({x, y, z}); };
  return {at(0.9, 0.8, 0.5) * Affine::rotate(0.7, {1, 2, 3}) * Affine::scale({0.3, 0.3, 0.3}),
          at(-0.8, 0.7, 0.6) * Affine::scale({-0.35, 0.3, 0.4}),
          at(0.2, -0.9, 0.9) * Affine::rotate(2, {0, 1, 1}) * Affine::scale({0.5, 0.12, 0.3}),
          at(-0.9, -0.9, 0.35) * Affine::rotate(-1, {1, 0, 1}) * Affine::scale({0.2, 0.3, -0.2}),
          at(0.1, 0.1, 1.4) * Affine::scale({0.04, 0.04, 0.04})};
}

// Returns a closed room with a ceiling lamp and instances of the ball at these places.
inline Scene room_of_instances(const std::vector<Affine>& places, int around = 12) {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.6f}), red = add_diffuse(s, {0.7f, 0.3f, 0.2f});
  add_box_inside(s, grey, {-2, -2, 0}, {2, 2, 2.5f});
  add_ceiling_light(s, 0.8f, 2.4f, Rgb{10});
  s.instanced_meshes.push_back(dented_ball(red, around));
  for (const Affine& place : places) add_instance(s, 0, place);
  return s;
}

// Returns the scene with its instances replaced by copies, after the other meshes, in order.
inline Scene copied_out(Scene s) {
  for (uint32_t i = 0; i < s.instances.size(); ++i)
    s.meshes.push_back(
        copied_to_world(MeshInWorld(s.instanced_meshes[s.instances[i].mesh], &s.instances[i])));
  s.instances.clear();
  s.instanced_meshes.clear();
  return s;
}

}  // namespace troffer::test
