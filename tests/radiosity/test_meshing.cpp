// Meshes: bounds, joining, round surfaces, lookup and malformed input.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "base/frame.h"
#include "base/random.h"
#include "base/warp.h"
#include "radiosity/rooms.h"

using namespace troffer;
using namespace troffer::test;

namespace {

void add_triangle(Mesh& m, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto first = uint32_t(m.positions.size());
  m.positions.insert(m.positions.end(), {a, b, c});
  m.triangles.push_back({first, first + 1, first + 2});
}

// Returns n × n squares of a 1 × 1 sheet in the plane z = 0.
Mesh grid(uint32_t n) {
  Mesh m;
  for (uint32_t i = 0; i <= n; ++i)
    for (uint32_t j = 0; j <= n; ++j)
      m.positions.push_back({float(i) / float(n), float(j) / float(n), 0});
  for (uint32_t i = 0; i < n; ++i)
    for (uint32_t j = 0; j < n; ++j) {
      const uint32_t v = i * (n + 1) + j;
      m.triangles.push_back({v, v + n + 1, v + 1});
      m.triangles.push_back({v + 1, v + n + 1, v + n + 2});
    }
  return m;
}

MeshingOptions all_sides(float element, float patch) {
  MeshingOptions o = sizes(element, patch);
  o.prune_hidden_sides = false;
  return o;
}

double front_area(const RadiosityMesh& mesh) {
  double a = 0;
  for (const Patch& p : mesh.patches)
    if (!p.is_back) a += double(p.area);
  return a;
}

}  // namespace

TEST_CASE("large triangles are cut, small ones joined") {
  Scene s;
  add_diffuse(s, Rgb{0.5f});
  s.meshes.push_back(grid(100));
  const Ready ready(std::move(s));
  const RadiosityMesh fine = ready.mesh(all_sides(0.1f, 0.4f));
  CHECK(front_area(fine) == doctest::Approx(1).epsilon(1e-4));
  CHECK(fine.fragments.size() == 20000);
  CHECK(fine.sheets.size() > 6);
  CHECK(fine.sheets.size() < 80);
  CHECK(fine.element_count > 150);
  CHECK(fine.element_count < 1500);
  const RadiosityMesh cut = ready.mesh(all_sides(0.003f, 0.006f));
  CHECK(front_area(cut) == doctest::Approx(1).epsilon(1e-4));
  CHECK(cut.element_count <= 24000);
}

TEST_CASE("two triangles make one polygon, and cuts leave no gaps") {
  Scene s;
  const uint32_t m = add_diffuse(s, Rgb{0.5f});
  add_quad(s, m, {Vec3{0, 0, 0}, {1, 0, 0}, {1, 0.7f, 0}, {0, 0.7f, 0}});
  const Ready ready(std::move(s));
  const RadiosityMesh mesh = ready.mesh(all_sides(0.1f, 2));
  REQUIRE(mesh.sheets.size() == 1);
  REQUIRE(mesh.pieces.size() == 1);
  CHECK(mesh.pieces[0][1] == 4);
  CHECK(mesh.patches.size() == 2);
  CHECK(front_area(mesh) == doctest::Approx(0.7).epsilon(1e-5));
  // An inner edge belongs to two fragments and an outer edge to one: no edge ends in the middle of
  // another.
  for (size_t v = 0; v + 1 < mesh.vertex_first.size(); ++v) {
    const Vec3 p = mesh.geometry.positions[v];
    if (!(p.x > 0.01f && p.x < 0.99f && p.y > 0.01f && p.y < 0.69f)) continue;
    double angle = 0;
    for (uint32_t i = mesh.vertex_first[v]; i < mesh.vertex_first[v + 1]; ++i) {
      const auto& f = mesh.fragments[mesh.vertex_fragments[i]].vertices;
      for (size_t k = 0; k < 3; ++k) {
        if (f[k] != v) continue;
        const Vec3 a = normalize(mesh.geometry.positions[f[(k + 1) % 3]] - p);
        const Vec3 b = normalize(mesh.geometry.positions[f[(k + 2) % 3]] - p);
        angle += std::acos(std::clamp(double(dot(a, b)), -1.0, 1.0));
      }
    }
    CHECK(angle == doctest::Approx(2 * pi).epsilon(1e-3));
  }
}

TEST_CASE("lookup finds the fragment that contains the point") {
  Scene s;
  const uint32_t m = add_diffuse(s, Rgb{0.5f});
  add_quad(s, m, {Vec3{0, 0, 0}, {2, 0, 0}, {2.5f, 1.7f, 0.3f}, {0, 1.7f, 0.3f}});
  s.spheres.push_back({{5, 0, 0}, 1.5f, false, m, no_light});
  s.spheres.push_back({{9, 0, 0}, 1.5f, true, m, no_light});
  s.disks.push_back({{5, 5, 0}, normalize(Vec3{1, 2, 3}), 0.8f, m, no_light});
  const Ready ready(std::move(s));
  const RadiosityMesh mesh = ready.mesh(all_sides(0.2f, 0.6f));
  Random r(3);
  const auto check = [&](uint32_t geometry, uint32_t primitive, Vec2 b, const Vec3& p, float most) {
    Vec3 w;
    bool is_back = false;
    const uint32_t f = fragment_at(ready.scene, mesh, geometry, primitive, b.x, b.y, p, is_back, w);
    CHECK(!is_back);
    REQUIRE(f != no_fragment);
    Vec3 q;
    for (size_t k = 0; k < 3; ++k)
      q += mesh.geometry.positions[mesh.fragments[f].vertices[k]] * w[k];
    CHECK(length(q - p) < most);
    CHECK(w.x + w.y + w.z == doctest::Approx(1).epsilon(1e-4));
  };
  for (int i = 0; i < 200; ++i) {
    const Vec2 b = triangle_from_square(r.next_vec2());
    const auto t = r.next_u32() % 2;
    const auto& quad = ready.scene.meshes[0];
    const Triangle& v = quad.triangles[t];
    check(0, t, b,
          quad.positions[v[0]] * (1 - b.x - b.y) + quad.positions[v[1]] * b.x +
              quad.positions[v[2]] * b.y,
          1e-5f);
    const uint32_t sphere = r.next_u32() % 2;
    check(1, sphere, {},
          ready.scene.spheres[sphere].centre + sphere_from_square(r.next_vec2()) * 1.5f, 0.03f);
    const Frame frame(ready.scene.disks[0].normal);
    const Vec2 d = disk_from_square(r.next_vec2()) * 0.8f;
    check(2, 0, {}, Vec3{5, 5, 0} + frame.tangent * d.x + frame.bitangent * d.y, 0.03f);
  }
  for (const ElementPoint& p : mesh.points) CHECK(length(p.normal) == doctest::Approx(1));
}

TEST_CASE("hidden sides neither shoot nor receive") {
  Scene s = lit_room(0.5f);
  const uint32_t m = add_diffuse(s, Rgb{0.5f});
  for (const uint32_t q : add_box_inside(s, m, {1, 1, 0.5f}, {1.5f, 1.5f, 1}))
    std::swap(s.meshes[q].positions[1], s.meshes[q].positions[3]);
  const Ready ready(std::move(s));
  const RadiosityMesh mesh = ready.mesh(sizes(0.2f, 0.8f));
  const double room = 2 * (4 * 3 + 4 * 2.5 + 3 * 2.5), block = 6 * 0.25, lamp = 2;
  double area = 0;
  for (const ElementPoint& p : mesh.points) area += double(p.area);
  CHECK(area == doctest::Approx(room + block + lamp).epsilon(1e-3));
}

TEST_CASE("interpolation reproduces a linear field and covers every place") {
  Scene s;
  const uint32_t m = add_diffuse(s, Rgb{0.5f});
  add_quad(s, m, {Vec3{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
  const Ready ready(std::move(s));
  const RadiosityMesh mesh = ready.mesh(all_sides(0.15f, 0.6f));
  Random r(5);
  Interpolation at;
  double worst = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec2 b = triangle_from_square(r.next_vec2());
    const auto t = r.next_u32() % 2;
    const Mesh& quad = ready.scene.meshes[0];
    const Triangle& v = quad.triangles[t];
    const Vec3 p = quad.positions[v[0]] * (1 - b.x - b.y) + quad.positions[v[1]] * b.x +
                   quad.positions[v[2]] * b.y;
    for (const bool is_back : {false, true}) {
      interpolate(ready.scene, mesh, 0, t, b.x, b.y, p, is_back, at);
      float sum = 0;
      Vec3 q;
      for (const PointWeight& w : at.weights()) {
        CHECK((mesh.points[w.point].normal.z < 0) == is_back);
        sum += w.weight;
        q += mesh.points[w.point].position * w.weight;
      }
      CHECK(sum == doctest::Approx(1).epsilon(1e-4));
      if (p.x > 0.2f && p.x < 1.8f && p.y > 0.2f && p.y < 1.8f)
        worst = std::max(worst, double(length(q - p)));
      CHECK(length(q - p) < 0.15f);
    }
  }
  CHECK(worst < 0.06);
}

TEST_CASE("300 000 triangles stay within the bounds") {
  Scene s;
  add_diffuse(s, Rgb{0.5f});
  Random r(11);
  Mesh m;
  for (int i = 0; i < 300000; ++i) {  // grass: no two triangles touch
    const Vec3 at = Vec3{r.next_float(), r.next_float(), 0.1f * r.next_float()} * 20;
    const Frame f(sphere_from_square(r.next_vec2()));
    add_triangle(m, at, at + f.tangent * 0.05f, at + f.bitangent * 0.05f);
  }
  s.meshes.push_back(std::move(m));
  const Ready ready(std::move(s));
  const RadiosityMesh mesh = ready.mesh(all_sides(0, 0));
  CHECK(mesh.element_count <= 24000);
  CHECK(mesh.element_count > 3000);
  CHECK(mesh.sheets.size() <= 3000);
  CHECK(mesh.sheets.size() > 300);
  CHECK(front_area(mesh) == doctest::Approx(300000 * 0.05 * 0.05 / 2).epsilon(0.01));
  MESSAGE("300 000 triangles: " << mesh.element_count << " elements, " << mesh.sheets.size()
                                << " sheets, " << double(mesh.memory_bytes()) * 1e-6 << " MB");
}

TEST_CASE("meshing of degenerate meshes terminates") {
  constexpr float inf = std::numeric_limits<float>::infinity(),
                  nan = std::numeric_limits<float>::quiet_NaN();
  Scene s = lit_room(0.5f);
  Mesh m;
  m.material = add_diffuse(s, Rgb{0.5f});
  add_triangle(m, {1, 1, 1}, {1, 1, 1}, {1, 1, 1});                      // a point
  add_triangle(m, {1, 1, 1}, {2, 1, 1}, {3, 1, 1});                      // a line
  add_triangle(m, {1, 1, 1}, {3, 1, 1}, {2, 1.000001f, 1});              // a sliver
  add_triangle(m, {0.5f, 0.5f, 1}, {3, 0.5f, 1}, {3, 0.5003f, 1.001f});  // a longer sliver
  for (int i = 0; i < 20; ++i) add_triangle(m, {1, 2, 1}, {1.5f, 2, 1}, {1, 2.5f, 1});  // copies
  add_triangle(m, {1, 2, 1}, {1, 2.5f, 1}, {1.5f, 2, 1});  // opposite orientation
  for (int i = 0; i < 200; ++i) {                          // a fan about one edge
    const float a = 0.03f * float(i);
    add_triangle(m, {2, 2, 1}, {2, 2, 1.3f}, {2 + 0.3f * std::cos(a), 2 + 0.3f * std::sin(a), 1});
  }
  SUBCASE("finite") {}
  SUBCASE("not finite") {
    add_triangle(m, {nan, 1, 1}, {2, 1, 1}, {1, 2, 1});
    add_triangle(m, {inf, 1, 1}, {2, 1, 1}, {1, 2, 1});
  }
  s.meshes.push_back(m);
  s.meshes.push_back({});
  s.spheres.push_back({{1, 1, 2}, 1e-4f, false, 0, no_light});
  const Ready ready(std::move(s));
  RadiosityOptions o;
  o.meshing = sizes(0.4f, 1.2f);
  const RadiositySolution solution = ready.solve(o);
  CHECK(solution.is_complete);
  Interpolation at;
  for (uint32_t i = 0; i < solution.mesh.points.size(); ++i)
    CHECK(is_finite(solution.irradiance(i)));
  const uint32_t index = uint32_t(ready.scene.meshes.size()) - 2;
  for (uint32_t t = 0; t < m.triangles.size(); ++t) {
    interpolate(ready.scene, solution.mesh, index, t, 0.3f, 0.3f, {}, false, at);
    CHECK(is_finite(interpolated_irradiance(solution, at)));
  }
  // Copies are one surface.
  double copies = 0;
  for (const ElementPoint& p : solution.mesh.points)
    if (p.position.z == 1 && p.position.y >= 2 && p.position.x >= 1 &&
        p.position.x + p.position.y < 3.5f && p.position.x < 1.5f)
      copies += double(p.area);
  CHECK(copies == doctest::Approx(2 * 0.125).epsilon(1e-3));
}

TEST_CASE("scenes without light or without surfaces") {
  Scene dark;
  add_box_inside(dark, add_diffuse(dark, Rgb{0.5f}), {0, 0, 0}, {1, 1, 1});
  const RadiositySolution a = Ready(std::move(dark)).solve();
  CHECK(a.is_complete);
  CHECK(a.shots == 0);
  const RadiositySolution b = Ready(Scene{}).solve();
  CHECK(b.is_complete);
  CHECK(b.mesh.points.empty());
}

TEST_CASE("textures set the reflectance of elements, masks their area") {
  Scene s;
  Material m;
  m.base_color.value = Rgb{1};
  m.base_color.texture = 0;
  m.is_alpha_masked = true;
  m.alpha.texture = 1;
  m.alpha.channel = 0;
  add_material(s, m);
  Texture t;  // left half dark, right half bright
  t.kind = TextureKind::image;
  t.width = 2;
  t.height = 1;
  t.channels = 1;
  t.is_filtered = false;
  t.texels_float = {0.2f, 0.6f};
  s.textures.push_back(t);
  t.width = 1;  // upper half masked out
  t.height = 2;
  t.texels_float = {0, 1};
  s.textures.push_back(t);
  add_quad(s, 0, {Vec3{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  s.meshes[0].uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const Ready ready(std::move(s));
  const RadiosityMesh mesh = ready.mesh(all_sides(0.1f, 0.3f));
  CHECK(front_area(mesh) == doctest::Approx(0.5).epsilon(0.02));
  for (const ElementPoint& p : mesh.points) {
    CHECK(p.position.y > 0.45f);
    if (p.position.x < 0.4f) CHECK(p.reflectance.g == doctest::Approx(0.2f));
    if (p.position.x > 0.6f) CHECK(p.reflectance.g == doctest::Approx(0.6f));
  }
}

// A solution file may request both.
TEST_CASE("impossible element sizes end at the bound instead of an endless mesh") {
  Scene s;
  add_box_inside(s, add_diffuse(s, Rgb{0.5f}), {0, 0, 0}, {4, 3, 2.5f});
  MeshingOptions o = sizes(1e-30f, 1e-30f);
  o.max_elements = 100;
  o.max_sheets = 1;  // fewer than walls: joining cannot suffice
  const RadiosityMesh mesh = Ready(std::move(s)).mesh(o);
  CHECK(mesh.element_count <= 1000);
  CHECK(mesh.coarsened > 1e20f);
}
