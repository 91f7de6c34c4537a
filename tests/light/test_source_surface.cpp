// SourceSurface: the unit square on whole lights, cells and bounds. LightPrimitives: pieces of
// lights, and lookup of pieces from hits.
#include <doctest/doctest.h>

#include <cmath>

#include "light/light_scene_set.h"
#include "light/polygon.h"
#include "light/source_surface.h"
#include "support/chi_square.h"

using namespace troffer;
using namespace troffer::test;

namespace {

std::vector<NamedScene> all_scenes() {
  std::vector<NamedScene> all = flat_scenes();
  all.push_back({"sphere", sphere_scene(0.7)});
  all.push_back({"hollow sphere", sphere_scene(0.7, true)});
  all.push_back({"mesh", mesh_scene({{0, 0, 0}, {1, 0, 0}, {0, 1, 0.5}, {2, 2, 1}, {2, 2, 1}},
                                    {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}})});
  return all;
}

}  // namespace

TEST_CASE("areas of source surfaces") {
  const std::vector<double> areas{1, 0.15, 0.47, 1, 0.78, pi * 0.49, 4 * pi * 0.49, 4 * pi * 0.49};
  const auto scenes = all_scenes();
  for (size_t i = 0; i < areas.size(); ++i)
    CHECK_MESSAGE(
        SourceSurface(scenes[i].scene, 0).area() == doctest::Approx(areas[i]).epsilon(1e-6),
        scenes[i].name);
}

TEST_CASE("point_at and uv_at are inverse, normals are unit, points lie on the piece") {
  Random random(1);
  for (const NamedScene& s : all_scenes()) {
    const SourceSurface surface(s.scene, 0);
    for (int i = 0; i < 2000; ++i) {
      const Vec2 uv = random.next_vec2();
      const SourcePoint p = surface.point_at(uv);
      CHECK(length(p.normal) == doctest::Approx(1).epsilon(1e-5));
      const Vec2 back = surface.uv_at(p.point, p.triangle);
      // Near a fan's apex or a pole, the point does not determine u.
      const float v_weight = s.name == "sphere" || s.name == "hollow sphere"
                                 ? std::sqrt(uv.y * (1 - uv.y))
                                 : std::sqrt(uv.y);
      const float du = std::abs(back.x - uv.x);
      CHECK_MESSAGE(std::min(du, 1 - du) * v_weight < 3e-5f, s.name << " " << uv.x << " " << uv.y);
      CHECK_MESSAGE(std::abs(back.y - uv.y) < 3e-5f, s.name << " " << uv.x << " " << uv.y);
    }
  }
}

TEST_CASE("the map from the square preserves area") {
  // χ² test over triangles of the mesh by index, and over halves of disk and sphere by geometry.
  const auto scenes = all_scenes();
  Random random(2);
  const int n = 40000;
  const NamedScene& mesh = scenes.back();
  const SourceSurface surface(mesh.scene, 0);
  const LightPrimitives primitives(mesh.scene);
  REQUIRE(primitives.size() == 2);  // the third triangle has no area
  std::vector<double> observed(2), expected(2);
  Vec2 mean_uv[2];
  for (int i = 0; i < n; ++i) {
    const SourcePoint p = surface.point_at(random.next_vec2());
    REQUIRE(p.triangle >= 0);
    REQUIRE(p.triangle < 2);
    observed[size_t(p.triangle)] += 1;
    mean_uv[p.triangle] = mean_uv[p.triangle] + p.texture_uv;
  }
  for (size_t t = 0; t < 2; ++t) {
    expected[t] = n * double(primitives[t].area) / surface.area();
    const Vec2 centre =
        (primitives[t].uvs[0] + primitives[t].uvs[1] + primitives[t].uvs[2]) * (1.0f / 3);
    CHECK(mean_uv[t].x / float(observed[t]) == doctest::Approx(centre.x).epsilon(0.02));
    CHECK(mean_uv[t].y / float(observed[t]) == doctest::Approx(centre.y).epsilon(0.02));
  }
  const auto result = chi_square_test(observed, expected, 1, 1e-4);
  CHECK_MESSAGE(result.is_accepted, result.text());
  for (size_t k = 2; k < scenes.size() - 1; ++k) {
    // The mean of uniform points is the centroid.
    const SourceSurface s(scenes[k].scene, 0);
    const LightPrimitives p(scenes[k].scene);
    Vec3d sum;
    const int side = 200;
    for (int i = 0; i < side * side; ++i)
      sum += Vec3d(
          s.point_at({(float(i % side) + 0.5f) / side, (float(i / side) + 0.5f) / side}).point);
    CHECK_MESSAGE(length(sum / double(side * side) - Vec3d(p[0].centroid)) < 1e-4, scenes[k].name);
  }
}

TEST_CASE("source cells: areas add up, bounds hold, corners of parallelograms are exact") {
  Random random(4);
  for (const NamedScene& s : all_scenes()) {
    const SourceSurface surface(s.scene, 0);
    CHECK(surface.cell_area({}) == doctest::Approx(surface.area()));
    for (int round = 0; round < 50; ++round) {
      const float size = std::exp2(-6 * random.next_float());
      SourceCell c;
      c.u0 = random.next_float() * (1 - size);
      c.v0 = random.next_float() * (1 - size);
      c.u1 = c.u0 + size;
      c.v1 = c.v0 + size * random.next_float();
      const Box box = surface.cell_bounds(c);
      for (int i = 0; i < 200; ++i) {
        const Vec3 p = surface
                           .point_at({lerp(c.u0, c.u1, random.next_float()),
                                      lerp(c.v0, c.v1, random.next_float())})
                           .point;
        for (size_t a = 0; a < 3; ++a) {
          CHECK_MESSAGE(p[a] >= box.lower[a], s.name);
          CHECK_MESSAGE(p[a] <= box.upper[a], s.name);
        }
      }
      if (surface.is_parallelogram()) {
        const auto k = surface.cell_corners(c);
        CHECK(double(length(cross(k[1] - k[0], k[3] - k[0]))) ==
              doctest::Approx(surface.cell_area(c)).epsilon(1e-3));
        CHECK(length(k[0] + k[2] - k[1] - k[3]) < 1e-6f);
      }
    }
  }
}

TEST_CASE("convex polygons are one source") {
  const std::vector<Vec3> slanted{{0, 0, 0}, {2, 0, 0}, {3, 1, 1}, {1, 1, 1}};
  const std::vector<Vec3> pentagon{
      {5, 0, 0}, {6, 0, 0}, {6.5f, 1, 0}, {5.5f, 1.7f, 0}, {4.6f, 1, 0}};
  const std::vector<Vec3> thin{{1, 1, 1}, {2, 2, 2}, {3, 3, 3}};
  const SourceSurface alone(std::vector<std::vector<Vec3>>{slanted});
  CHECK(alone.is_parallelogram());
  CHECK(alone.area() == doctest::Approx(2 * std::sqrt(2.0)));
  CHECK(alone.point_at({0.5f, 0.5f}).point == Vec3{1.5f, 0.5f, 0.5f});
  CHECK(SourceSurface(std::vector<std::vector<Vec3>>{thin}).area() == 0);
  const std::vector<std::vector<Vec3>> polygons{slanted, thin, pentagon};
  const SourceSurface surface(polygons);
  CHECK_FALSE(surface.is_parallelogram());
  std::vector<double> observed(3), expected(3);
  for (size_t i = 0; i < 3; ++i)
    expected[i] = length(area_vector(polygons[i])) / surface.area() * 20000;
  CHECK(expected[0] + expected[2] == doctest::Approx(20000));
  Random random(3);
  for (int i = 0; i < 20000; ++i) {
    const Vec2 uv = random.next_vec2();
    const SourcePoint p = surface.point_at(uv);
    REQUIRE(p.triangle >= 0);
    observed[size_t(p.triangle)] += 1;
    const Vec3d normal = area_vector(polygons[size_t(p.triangle)]);
    CHECK(dot(normal, Vec3d(p.normal)) == doctest::Approx(length(normal)).epsilon(1e-5));
    const Vec2 back = surface.uv_at(p.point, p.triangle);
    CHECK(std::abs(back.x - uv.x) * std::sqrt(uv.y) < 3e-5f);
    CHECK(std::abs(back.y - uv.y) < 3e-5f);
  }
  CHECK(observed[1] == 0);
  observed.erase(observed.begin() + 1);
  expected.erase(expected.begin() + 1);
  const auto result = chi_square_test(observed, expected, 1, 1e-4);
  CHECK_MESSAGE(result.is_accepted, result.text());
}

TEST_CASE("source pieces have the expected shapes, tables, power and cones") {
  const auto scenes = flat_scenes();
  const PrimitiveShape shapes[] = {PrimitiveShape::rectangle, PrimitiveShape::rectangle,
                                   PrimitiveShape::triangle,  PrimitiveShape::polygon,
                                   PrimitiveShape::polygon,   PrimitiveShape::disk};
  for (size_t i = 0; i < scenes.size(); ++i) {
    const LightPrimitives p(scenes[i].scene);
    REQUIRE(p.size() == 1);
    CHECK_MESSAGE(p[0].shape == shapes[i], scenes[i].name);
    CHECK(p[0].power == doctest::Approx(pi * double(p[0].area) * 2));
    CHECK(p[0].cos_cone == 1);
    CHECK(double(dot(p[0].cone_axis, Vec3(Pose{}.frame.normal))) == doctest::Approx(1));
    if (shapes[i] == PrimitiveShape::disk)
      CHECK(p.of_disk(0) == 0);
    else
      CHECK(p.of_triangle(0, 0) == 0);
  }
  const LightPrimitives hexagon(scenes[4].scene);
  CHECK(hexagon.of_triangle(0, 3) == 0);
  CHECK(hexagon[0].vertex_count == 6);
  const Scene mesh = all_scenes().back().scene;
  LightPrimitives parts(mesh);
  CHECK(parts.of_triangle(0, 0) == 0);
  CHECK(parts.of_triangle(0, 1) == 1);
  CHECK(parts.of_triangle(0, 2) == no_primitive);
  const LightPrimitives moved = std::move(parts);
  CHECK(moved.of_light(0).last == 2);

  Scene dark = sphere_scene(1);
  dark.lights[0].radiance = Rgb{0};
  CHECK(LightPrimitives(dark).size() == 0);
  CHECK(LightPrimitives(dark).of_sphere(0) == no_primitive);
  const LightPrimitives two(sphere_scene(1, false, true));
  CHECK(two[0].cos_cone == -1);
  CHECK(two[0].power == doctest::Approx(4 * pi * pi * 2 * 2));
}

TEST_CASE("a textured triangle's mean radiance is the texture's mean over it") {
  Scene s = mesh_scene({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  Texture t;
  t.kind = TextureKind::image;
  t.width = 8;
  t.height = 8;
  t.channels = 1;
  t.is_srgb = false;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) t.texels_float.push_back(float(x) / 8 + 1.0f / 16);  // equals u
  s.textures.push_back(t);
  s.lights[0].texture = 0;
  const LightPrimitives p(s);
  REQUIRE(p.size() == 1);
  CHECK(p[0].is_textured);
  // The mean of u over the triangle (0,0) (1,0) (0,1) is 1/3, except for bilinear wrapping at the
  // edges.
  CHECK(p[0].mean_radiance.r == doctest::Approx(2.0 / 3).epsilon(0.1));
}

namespace {

// A triangle light over the lower left half of the texture square, with an image of `lit` texels.
Scene triangle_with_image(int size, const std::vector<std::pair<int, int>>& lit) {
  Scene s = mesh_scene({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  s.meshes[0].uvs = {{0, 0}, {1, 0}, {0, 1}};
  Texture t;
  t.kind = TextureKind::image;
  t.width = t.height = size;
  t.channels = 1;
  t.is_srgb = t.is_filtered = false;
  t.texels_float.assign(size_t(size) * size_t(size), 0);
  for (const auto& [x, y] : lit) t.texels_float[size_t(y) * size_t(size) + size_t(x)] = 1;
  s.textures.push_back(t);
  return s;
}

}  // namespace

TEST_CASE("a source lit in one texel only has power") {
  Scene s = triangle_with_image(100, {{31, 17}});
  s.lights[0].texture = 0;
  const LightPrimitives p(s);
  REQUIRE(p.size() == 1);
  CHECK(p[0].power > 0);
  CHECK(p[0].mean_radiance.r == doctest::Approx(2.0 * 2e-4).epsilon(0.5));
}

TEST_CASE("holes of an alpha mask reduce a source's power by their share") {
  // holes where v > 1/2: a quarter of the triangle
  Scene s = triangle_with_image(2, {{0, 0}, {1, 0}});
  s.materials.resize(1);
  s.materials[0].is_alpha_masked = true;
  s.materials[0].alpha = {1, 0, 0};
  s.lights[0].is_alpha_masked = true;
  const LightPrimitives p(s);
  REQUIRE(p.size() == 1);
  CHECK(p[0].is_textured);
  CHECK(p[0].mean_radiance.r == doctest::Approx(2.0 * 0.75).epsilon(0.1));
}
