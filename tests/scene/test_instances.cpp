#include <doctest/doctest.h>

#include <cmath>

#include "scene/mesh_in_world.h"
#include "support/instanced_scenes.h"

using namespace troffer;
using namespace troffer::test;

TEST_CASE("corners of instances equal those of copies bit for bit, with the front outside") {
  const Scene scene = room_of_instances(places_in_room());
  const Scene copies = copied_out(scene);
  CHECK(triangle_count(scene) == triangle_count(copies));
  CHECK(stored_triangle_count(scene) < stored_triangle_count(copies));
  CHECK(bounds(scene).lower == bounds(copies).lower);
  CHECK(bounds(scene).upper == bounds(copies).upper);
  for (uint32_t k = 0; k < scene.instances.size(); ++k) {
    const uint32_t geometry = first_instance(scene) + k;
    CHECK(is_mesh(scene, geometry));
    const MeshInWorld mesh = mesh_at(scene, geometry);
    const Mesh& copy = copies.meshes[scene.meshes.size() + k];
    const Vec3 middle(scene.instances[k].world_from_mesh.translation);
    for (size_t t = 0; t < mesh.size(); ++t) {
      const auto [a, b, c] = mesh.corners(t);
      CHECK(a == copy.positions[copy.triangles[t][0]]);
      CHECK(b == copy.positions[copy.triangles[t][1]]);
      CHECK(c == copy.positions[copy.triangles[t][2]]);
      // Front and normals point outwards, under mirroring transforms too.
      CHECK(dot(cross(b - a, c - a), a - middle) > 0);
      const Vec3 n = mesh.normal(mesh.triangle(t)[0]);
      CHECK(n == copy.normals[copy.triangles[t][0]]);
      CHECK(std::abs(length(n) - 1) < 1e-6f);
      CHECK(dot(n, a - middle) > 0);
    }
  }
  CHECK_FALSE(is_mesh(scene, uint32_t(scene.meshes.size())));
  CHECK_FALSE(is_mesh(scene, uint32_t(scene.meshes.size()) + 1));
}

TEST_CASE("transforms that rays do not survive are not used for instances") {
  CHECK(is_instanceable(Affine()));
  CHECK(is_instanceable(Affine::rotate(1, {1, 2, 3}) * Affine::scale({1e-3, 5, 1e3})));
  CHECK(is_instanceable(Affine::scale({-1, 1, 1})));
  CHECK_FALSE(is_instanceable(Affine::scale({0, 1, 1})));
  CHECK_FALSE(is_instanceable(Affine::scale({1e-10, 1e-10, 1e-10})));
  CHECK_FALSE(is_instanceable(Affine::scale({1e10, 1e10, 1e10})));
  CHECK_FALSE(is_instanceable(Affine::scale({std::nan(""), 1, 1})));
  CHECK_FALSE(is_instanceable(Affine::translate({0, std::nan(""), 0})));
  // A stretch along a direction that is no world axis, then a rotation: rays would lose precision.
  CHECK_FALSE(is_instanceable(Affine::scale({1000, 1, 1}) * Affine::rotate(0.8, {0, 0, 1})));
}
