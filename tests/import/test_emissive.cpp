// Tests which emissive meshes become polygon lights.
#include <doctest/doctest.h>

#include <cmath>

#include "base/random.h"
#include "base/transform.h"
#include "import/emissive.h"
#include "support/stopwatch.h"

using namespace troffer;

namespace test_emissive {

namespace {

Mesh mesh_of(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles) {
  Mesh mesh;
  mesh.positions = positions;
  mesh.triangles = triangles;
  return mesh;
}

Scene emitting(const Mesh& mesh, Rgb radiance = Rgb{1}) {
  Scene scene;
  scene.materials.emplace_back();
  scene.meshes.push_back(mesh);
  EmissionSpec spec;
  spec.name = "lamp";
  spec.radiance = radiance;
  add_mesh_lights(scene, 0, spec);
  return scene;
}

Vec3d newell(const std::vector<Vec3>& p) {
  Vec3d sum;
  for (size_t i = 2; i < p.size(); ++i)
    sum += cross(Vec3d(p[i - 1]) - Vec3d(p[0]), Vec3d(p[i]) - Vec3d(p[0])) * 0.5;
  return sum;
}

double area(const Mesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    sum += length(newell({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]}));
  return sum;
}

// Returns a regular n-gon of radius r as a fan around its centre, vertex 0.
Mesh disk(uint32_t n, float r = 1) {
  Mesh mesh;
  mesh.positions.push_back({0, 0, 0});
  for (uint32_t i = 0; i < n; ++i) {
    const double a = 2 * pi * i / n;
    mesh.positions.push_back({r * float(std::cos(a)), r * float(std::sin(a)), 0});
    mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % n});
  }
  return mesh;
}

const Mesh square = mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});

}  // namespace

TEST_CASE("a square of two triangles is one polygon, counterclockwise from the front") {
  const Scene scene = emitting(square, Rgb{2});
  REQUIRE(scene.lights.size() == 1);
  const Light& e = scene.lights[0];
  CHECK(e.kind == LightKind::polygon);
  CHECK(e.name == "lamp");
  CHECK(e.radiance == Rgb{2});
  CHECK(e.polygon.size() == 4);
  CHECK(newell(e.polygon).z == doctest::Approx(1));
  CHECK(scene.meshes[0].lights == std::vector<int32_t>{0, 0});
}

TEST_CASE("separate vertices for every triangle make no difference") {
  const Mesh split =
      mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, -0.0f, -0.0f}, {1, 1, 0}, {0, 1, 0}},
              {{0, 1, 2}, {3, 4, 5}});
  const Scene scene = emitting(split);
  REQUIRE(scene.lights.size() == 1);
  CHECK(scene.lights[0].polygon.size() == 4);
}

TEST_CASE("polygons of any number of corners, and a grid with collinear ones") {
  for (const uint32_t n : {3u, 5u, 8u, 33u, 64u}) {
    const Scene scene = emitting(disk(n));
    REQUIRE(scene.lights.size() == 1);
    CHECK(scene.lights[0].polygon.size() == n);
    CHECK(scene.lights[0].triangles.size() == n);
  }
  Mesh grid;
  const uint32_t n = 20;
  for (uint32_t j = 0; j <= n; ++j)
    for (uint32_t i = 0; i <= n; ++i)
      grid.positions.push_back({0.1f * float(i), 0.3f * float(j), 7});
  for (uint32_t j = 0; j < n; ++j)
    for (uint32_t i = 0; i < n; ++i) {
      const uint32_t a = j * (n + 1) + i, b = a + n + 1;
      grid.triangles.push_back({a, a + 1, b + 1});
      grid.triangles.push_back({a, b + 1, b});
    }
  const Scene scene = emitting(grid);
  REQUIRE(scene.lights.size() == 1);
  CHECK(scene.lights[0].polygon.size() == 4);
  CHECK(newell(scene.lights[0].polygon).z == doctest::Approx(2.0 * 6.0));
}

TEST_CASE("property: transformed polygons keep their corners, front and area") {
  Random random(7);
  for (int trial = 0; trial < 200; ++trial) {
    const uint32_t n = 3 + random.next_u32() % 20;
    Mesh mesh = disk(n, 0.05f + random.next_float());
    const Affine move =
        Affine::translate({10 * random.next_double(), -5 * random.next_double(), 3}) *
        Affine::rotate(6 * random.next_double(),
                       {random.next_double() - 0.5, random.next_double() - 0.5, 0.3});
    for (Vec3& p : mesh.positions) p = Vec3(move.point(Vec3d(p)));
    const bool is_flipped = trial % 2 == 1;
    if (is_flipped)
      for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    const Scene scene = emitting(mesh);
    REQUIRE(scene.lights.size() == 1);
    const Light& e = scene.lights[0];
    REQUIRE(e.kind == LightKind::polygon);
    CHECK(e.polygon.size() == n);
    const Vec3d normal = newell(e.polygon);
    CHECK(length(normal) == doctest::Approx(area(mesh)).epsilon(1e-4));
    CHECK(dot(normal, move.vector({0, 0, is_flipped ? -1.0 : 1.0})) > 0.99 * length(normal));
  }
}

TEST_CASE("sources that are not planar convex polygons stay meshes") {
  const auto is_mesh = [](const Mesh& mesh) {
    const Scene scene = emitting(mesh);
    return scene.lights.size() == 1 && scene.lights[0].kind == LightKind::mesh &&
           scene.lights[0].triangles.size() == mesh.triangles.size() &&
           scene.lights[0].polygon.empty();
  };
  Mesh bent = square;
  for (const float off : {0.01f, 1e-4f, 1e-5f}) {  // would hide the polygon from shadow rays
    bent.positions[2].z = off;
    CHECK(is_mesh(bent));
  }
  bent.positions[2].z = 1e-7f;  // rounding
  CHECK(emitting(bent).lights[0].kind == LightKind::polygon);
  Mesh dart = square;  // a reflex corner
  dart.positions[2] = {0.2f, 0.2f, 0};
  dart.triangles = {{0, 1, 2}, {0, 2, 3}};
  CHECK(is_mesh(dart));
  Mesh back_to_back = square;
  back_to_back.triangles = {{0, 1, 2}, {0, 2, 1}};
  CHECK(is_mesh(back_to_back));
  Mesh inconsistent = square;
  inconsistent.triangles = {{0, 1, 2}, {0, 3, 2}};
  CHECK(is_mesh(inconsistent));
  Mesh twice = square;
  twice.triangles.push_back({0, 1, 2});
  CHECK(is_mesh(twice));
  CHECK(is_mesh(disk(65)));  // more corners than a polygon light may have
  // A fan that goes round twice: convex turns, but overlapping triangles.
  Mesh winding = disk(5);
  winding.triangles.clear();
  for (uint32_t i = 0; i < 5; ++i) winding.triangles.push_back({0, 1 + i, 1 + (i + 2) % 5});
  CHECK(is_mesh(winding));
  // A square ring: two boundary loops.
  Mesh ring;
  for (const float r : {2.0f, 1.0f})
    for (const Vec3 p : {Vec3{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}})
      ring.positions.push_back(p * r);
  for (uint32_t i = 0; i < 4; ++i) {
    const uint32_t j = (i + 1) % 4;
    ring.triangles.push_back({i, j, 4 + j});
    ring.triangles.push_back({i, 4 + j, 4 + i});
  }
  CHECK(is_mesh(ring));
}

TEST_CASE("separate components become separate sources, the rest one mesh source") {
  Mesh mesh = square;
  for (const Vec3& p : square.positions) mesh.positions.push_back(p + Vec3{0, 0, 5});
  mesh.triangles.push_back({4, 5, 6});
  mesh.triangles.push_back({4, 6, 7});
  // A corner bent off the plane.
  for (const Vec3& p : square.positions) mesh.positions.push_back(p + Vec3{9, 0, 0});
  mesh.positions.back().z = 1;
  mesh.triangles.push_back({8, 9, 10});
  mesh.triangles.push_back({8, 10, 11});
  // Touches the first square at one corner only.
  mesh.positions.insert(mesh.positions.end(), {{1, 1, 0}, {2, 1, 0}, {2, 2, 0}});
  mesh.triangles.push_back({12, 13, 14});
  const Scene scene = emitting(mesh);
  REQUIRE(scene.lights.size() == 4);
  CHECK(scene.lights[0].polygon.size() == 4);
  CHECK(scene.lights[1].polygon.size() == 4);
  CHECK(scene.lights[2].polygon.size() == 3);
  CHECK(scene.lights[3].kind == LightKind::mesh);
  CHECK(scene.meshes[0].lights == std::vector<int32_t>{0, 0, 1, 1, 3, 3, 2});
}

TEST_CASE("no area, no emission, constant textures") {
  Mesh flat = square;
  for (Vec3& p : flat.positions) p.y = 0;
  Scene scene = emitting(flat);
  CHECK(scene.lights.empty());
  CHECK(scene.meshes[0].lights.empty());
  CHECK(scene.warnings.total() == 1);
  CHECK(emitting(square, Rgb{0}).lights.empty());
  CHECK(emitting(Mesh{}).lights.empty());

  scene = Scene{};
  scene.meshes.push_back(square);
  Texture half;
  half.value = Rgb{0.5f};
  scene.textures.push_back(half);
  add_mesh_lights(scene, 0, {"x", Rgb{4}, 0, true});
  REQUIRE(scene.lights.size() == 1);
  CHECK(scene.lights[0].kind == LightKind::polygon);
  CHECK(scene.lights[0].radiance == Rgb{2});
  CHECK(scene.lights[0].texture == no_texture);
  CHECK(scene.lights[0].is_two_sided);
}

TEST_CASE("a source with an alpha mask stays a mesh with its holes") {
  Scene scene;
  Material masked;
  masked.is_alpha_masked = true;
  masked.alpha.value = 0.25f;
  scene.materials.push_back(masked);
  scene.meshes.push_back(square);
  add_mesh_lights(scene, 0, {"x", Rgb{4}, no_texture, false});
  REQUIRE(scene.lights.size() == 1);
  CHECK(scene.lights[0].kind == LightKind::mesh);
  CHECK(scene.lights[0].is_alpha_masked);
  CHECK(emitted_radiance(scene, scene.lights[0], true, {}) == Rgb{0});
  scene.materials[0].alpha.value = 0.75f;
  CHECK(emitted_radiance(scene, scene.lights[0], true, {}) == Rgb{4});
}

TEST_CASE("large emissive meshes take near-linear time, and polygons are limited") {
  Mesh many;
  for (uint32_t i = 0; i < 3000; ++i) {
    const Vec3 at{float(i % 60) * 2, float(i / 60) * 2, 0};
    const auto first = uint32_t(many.positions.size());
    for (const Vec3& p : square.positions) many.positions.push_back(p + at);
    many.triangles.push_back({first, first + 1, first + 2});
    many.triangles.push_back({first, first + 2, first + 3});
  }
  const Scene limited = emitting(many);
  CHECK(limited.lights.size() == 1001);
  CHECK(limited.lights.back().kind == LightKind::mesh);
  CHECK(limited.lights.back().triangles.size() == 4000);

  // A flat disk of many triangles with a ragged rim, and a bumpy grid.
  Mesh grid;
  const uint32_t n = 250;
  Random random(3);
  for (uint32_t j = 0; j <= n; ++j)
    for (uint32_t i = 0; i <= n; ++i)
      grid.positions.push_back({float(i), float(j), random.next_float()});
  for (uint32_t j = 0; j < n; ++j)
    for (uint32_t i = 0; i < n; ++i) {
      const uint32_t a = j * (n + 1) + i, b = a + n + 1;
      grid.triangles.push_back({a, a + 1, b + 1});
      grid.triangles.push_back({a, b + 1, b});
    }
  const test::ProcessorStopwatch watch;
  const Scene bumpy = emitting(grid);
  const Scene fan = emitting(disk(100'000));
  const double seconds = watch.seconds();
  CHECK(bumpy.lights.size() == 1);
  CHECK(fan.lights.size() == 1);
  CHECK(seconds < 5);
}

}  // namespace test_emissive
