// Tests of merging tessellated lights into sources.
#include "shadow/source_pieces.h"

#include <doctest/doctest.h>

#include <cmath>
#include <set>

#include "base/units.h"
#include "light/irradiance.h"
#include "support/light_scenes.h"
#include "support/tessellations.h"

using namespace troffer;
using namespace troffer::test;

namespace {

double area_of(const FlatSource& s) {
  const std::vector<Vec3d> c = s.corners();
  Vec3d sum;
  for (size_t i = 1; i + 1 < c.size(); ++i) sum += cross(c[i] - c[0], c[i + 1] - c[0]);
  return s.is_disk ? pi / 4 * length_squared(s.plane.u) : 0.5 * length(sum);
}

double irradiance_of(const FlatSource& s, const Vec3d& x, const Vec3d& n) {
  if (s.is_disk)
    return disk_irradiance(s.plane.origin + (s.plane.u + s.plane.v) * 0.5, s.plane.normal,
                           0.5 * length(s.plane.u), x, n);
  return polygon_irradiance(s.corners(), x, n);
}

Scene scene_with(const Tessellation& t, const Place& place) {
  Scene s;
  add_diffuse(s, Rgb{0.5f});
  Mesh m;
  append(m, t, place);
  add_mesh_light(s, 0, m.positions, m.triangles, Rgb{2}, false);
  return s;
}

// Checks that each primitive is covered and that areas and irradiances agree. Returns the number of
// sources.
size_t check_sources(const Scene& scene, uint64_t seed, double tolerance = 1e-6) {
  const LightPrimitives lights(scene);
  std::vector<SourcePiece> pieces;
  REQUIRE(merge_sources(lights, 0, pieces));
  double expected = 0, area = 0, size = 0;
  std::set<uint32_t> covered;
  for (const LightPrimitive& p : lights.all()) {
    expected += double(p.area);
    size = std::max(size, double(length(p.bounds.extent())));
  }
  for (const SourcePiece& piece : pieces) {
    area += area_of(piece.shape);
    CHECK(piece.shape.outline.size() <= most_outline_corners);
    CHECK_FALSE(piece.primitives.empty());
    double of_primitives = 0;
    for (const uint32_t p : piece.primitives) {
      CHECK(covered.insert(p).second);
      of_primitives += double(lights[p].area);
      CHECK(dot(lights[p].normal, piece.shape.plane.normal) > 0.999);
    }
    CHECK(area_of(piece.shape) == doctest::Approx(of_primitives).epsilon(1e-5));
  }
  CHECK(covered.size() == lights.size());
  CHECK(area == doctest::Approx(expected).epsilon(tolerance));
  Random r(seed);
  for (int i = 0; i < 20; ++i) {
    const LightPrimitive& p = lights[r.next_u32() % lights.size()];
    const Vec3d x = Vec3d(p.centroid) + p.normal * (0.2 + 3 * r.next_double()) +
                    Vec3d(random_direction(r)) * 0.2;
    const Vec3d n(random_direction(r));
    double merged = 0;
    for (const SourcePiece& piece : pieces) merged += irradiance_of(piece.shape, x, n);
    CHECK(std::abs(merged - irradiance(lights, 0, x, n)) <= tolerance * pi);
  }
  return pieces.size();
}

std::vector<Vec2d> regular(uint32_t n, double radius) {
  std::vector<Vec2d> c;
  for (uint32_t i = 0; i < n; ++i)
    c.push_back({radius * std::cos(2 * pi * i / n), radius * std::sin(2 * pi * i / n)});
  return c;
}

Tessellation fan_about_centre(uint32_t n, double radius) {
  Tessellation t;
  t.points = regular(n, radius);
  t.points.push_back({0, 0});
  for (uint32_t i = 0; i < n; ++i) t.triangles.push_back({n, i, (i + 1) % n});
  return t;
}

}  // namespace

TEST_CASE("a tessellated panel is one source") {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    Random r(seed);
    const Place place = seed % 3 == 0 ? Place{} : random_place(r, 3);
    CAPTURE(seed);
    const Scene grid = scene_with(random_grid(r, 9, 5, 1.2, 0.6), place);
    CHECK(check_sources(grid, seed) == 1);
    std::vector<SourcePiece> pieces;
    REQUIRE(merge_sources(LightPrimitives(grid), 0, pieces));
    CHECK(pieces[0].shape.outline.empty());  // a parallelogram without clipping
    CHECK(pieces[0].primitives.size() == 90);

    const auto corner = [](uint32_t i, uint32_t j) { return i >= 4 && j >= 3; };
    CHECK(check_sources(scene_with(random_grid(r, 9, 7, 2, 1, corner), place), seed) == 2);
    const auto hole = [](uint32_t i, uint32_t j) { return i >= 3 && i < 6 && j >= 2 && j < 5; };
    CHECK(check_sources(scene_with(random_grid(r, 9, 7, 2, 1, hole), place), seed) <= 4);
    for (const uint32_t n : {3u, 5u, 8u, 11u})
      CHECK(check_sources(scene_with(random_splits(r, regular(n, 0.7), 50, 0.2), place), seed) ==
            1);
    // oblique
    const std::vector<Vec2d> rhomboid{{0, 0}, {1, 0}, {1.4, 0.8}, {0.4, 0.8}};
    CHECK(check_sources(scene_with(random_splits(r, rhomboid, 50, 0.2), place), seed) == 1);
  }
}

TEST_CASE("10 000 triangles of a panel are one source") {
  Random r(5);
  CHECK(check_sources(scene_with(random_grid(r, 100, 50, 1.2, 0.6), random_place(r, 3)), 1) == 1);
}

TEST_CASE("round panels are few sources") {
  Random r(7);
  const Place place = random_place(r, 3);
  CHECK(check_sources(scene_with(fan_about_centre(11, 0.5), place), 1) == 1);
  CHECK(check_sources(scene_with(fan_about_centre(32, 0.5), place), 1) <= 6);
  CHECK(check_sources(scene_with(fan_about_centre(64, 0.5), place), 1) <= 12);
}

TEST_CASE("polygons with many corners are divided, disks stay whole") {
  Random r(2);
  for (const uint32_t n : {4u, 11u, 12u, 40u, 64u}) {
    Scene s;
    add_diffuse(s, Rgb{0.5f});
    Mesh m;
    const Place place = random_place(r, 2);
    Tessellation t;
    t.points = regular(n, 0.8);
    for (uint32_t i = 1; i + 1 < n; ++i) t.triangles.push_back({0, i, i + 1});
    append(m, t, place);
    add_mesh_light(s, 0, m.positions, m.triangles, Rgb{1}, false);
    s.lights[0].kind = LightKind::polygon;
    s.lights[0].polygon = m.positions;
    const LightPrimitives lights(s);
    std::vector<SourcePiece> pieces;
    REQUIRE(merge_sources(lights, 0, pieces));
    CHECK(pieces.size() == (n <= 11 ? 1 : (n - 2 + 8) / 9));
    for (int i = 0; i < 10; ++i) {
      const Vec3d x = place.origin + place.frame.normal + Vec3d(random_direction(r)) * 0.8;
      const Vec3d normal(random_direction(r));
      double sum = 0;
      for (const SourcePiece& p : pieces) sum += irradiance_of(p.shape, x, normal);
      CHECK(std::abs(sum - irradiance(lights, 0, x, normal)) < 1e-6);
    }
  }
  Scene disk;
  add_diffuse(disk, Rgb{0.5f});
  add_disk_light(disk, 0, {0.2f, 0.3f, 1}, {0, 0, 1}, 0.4f, Rgb{1});
  CHECK(check_sources(disk, 3) == 1);
}

TEST_CASE("curved, round and textured emitters become sources") {
  // an octahedron: eight planes
  Scene s;
  add_diffuse(s, Rgb{0.5f});
  const std::vector<Vec3> tips{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const std::vector<Triangle> sides{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                    {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  add_mesh_light(s, 0, tips, sides, Rgb{1}, false);
  CHECK(check_sources(s, 1) == 8);
  std::vector<SourcePiece> pieces(3);
  Scene sphere;
  add_diffuse(sphere, Rgb{0.5f});
  add_sphere_light(sphere, 0, {0, 0, 0}, 1, Rgb{1});
  CHECK_FALSE(merge_sources(LightPrimitives(sphere), 0, pieces));
  CHECK(pieces.empty());
  s.textures.resize(1);
  s.meshes[0].uvs.resize(6);
  s.lights[0].texture = 0;
  CHECK_FALSE(merge_sources(LightPrimitives(s), 0, pieces));
  CHECK(pieces.empty());
}
