// Tests proofs that a place is enclosed: against rays, and by the rooms that are found.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <vector>

#include "base/random.h"
#include "support/light_scenes.h"
#include "trace/closed_shells.h"
#include "trace/tracer.h"

using namespace troffer;
using namespace troffer::test;

namespace {

using Corners = std::array<Vec3, 3>;

void add_triangles(Scene& s, uint32_t material, const std::vector<Corners>& triangles) {
  Mesh m;
  m.material = material;
  for (const Corners& t : triangles) {
    const auto first = uint32_t(m.positions.size());
    m.positions.insert(m.positions.end(), t.begin(), t.end());
    m.triangles.push_back({first, first + 1, first + 2});
  }
  s.meshes.push_back(std::move(m));
}

// Returns a box whose faces are grids of n × n squares with bumps.
std::vector<Corners> bumpy_box(Random& r, int n, const Vec3& lower, const Vec3& size, float bump) {
  const auto at = [&](int i, int j, int k) {
    Random own(hash_of(uint64_t(i), uint64_t(j), uint64_t(k)));
    const Vec3 grid{float(i) / float(n), float(j) / float(n), float(k) / float(n)};
    return lower + Vec3{grid.x * size.x, grid.y * size.y, grid.z * size.z} +
           random_direction(own) * (bump / float(n));
  };
  std::vector<Corners> out;
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    if (r.next_u32() % 2 == 0) {
      out.push_back({a, b, c});
      out.push_back({c, a, d});
    } else {
      out.push_back({a, d, b});  // either winding
      out.push_back({b, c, d});
    }
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (const int k : {0, n}) {
        add(at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k));
        add(at(i, k, j), at(i + 1, k, j), at(i + 1, k, j + 1), at(i, k, j + 1));
        add(at(k, i, j), at(k, i + 1, j), at(k, i + 1, j + 1), at(k, i, j + 1));
      }
  return out;
}

// Returns a scene of nested boxes, tables and sheets, closed or open by chance. targets: the
// triangles of the boxes before damage.
Scene random_scene(Random& r, std::vector<Corners>& targets) {
  targets.clear();
  Scene s;
  const uint32_t m = add_diffuse(s, Rgb{0.5f});
  const int boxes = 1 + int(r.next_u32() % 3);
  for (int b = 0; b < boxes; ++b) {
    const Vec3 size{random_size(r, 1, 8), random_size(r, 1, 8), random_size(r, 1, 8)};
    std::vector<Corners> box =
        bumpy_box(r, 1 + int(r.next_u32() % 5), random_point(r, 3) - size * 0.5f, size,
                  r.next_u32() % 2 == 0 ? 0.0f : 0.3f);
    targets.insert(targets.end(), box.begin(), box.end());
    const uint32_t holes = r.next_u32() % 3;
    for (uint32_t h = 0; h < holes; ++h) {
      const size_t at = r.next_u32() % box.size();
      if (r.next_u32() % 2 == 0)
        box.erase(box.begin() + std::ptrdiff_t(at));
      else if (r.next_u32() % 2 == 0)
        box[at][0] += random_direction(r) * 0.01f;  // a slit
      else
        box.push_back(box[at]);  // twice: crossed twice or not at all
    }
    add_triangles(s, m, box);
  }
  for (uint32_t i = r.next_u32() % 4; i > 0; --i)
    add_triangles(s, m, {{random_point(r, 4), random_point(r, 4), random_point(r, 4)}});
  return s;
}

bool is_held(const Scene& s, const Vec3& p) {
  return ClosedShells(s, nullptr).hold(p);
}

}  // namespace

TEST_CASE("no ray leaves a space that is proved closed") {
  Random r(41);
  int held = 0, free = 0;
  std::vector<Corners> targets;
  for (int scene = 0; scene < 2000; ++scene) {
    const Scene s = random_scene(r, targets);
    const ClosedShells shells(s, nullptr);
    const Tracer tracer(s);
    std::vector<Ray> rays;
    for (int i = 0; i < 40; ++i) {
      const Vec3 p = random_point(r, 2.5f);
      if (!shells.hold(p)) {
        ++free;
        continue;
      }
      ++held;
      // half of the rays aim at possible gaps and at edges
      for (int k = 0; k < 32; ++k) {
        Ray& ray = rays.emplace_back();
        ray.origin = p;
        ray.direction = random_direction(r);
        if (k % 2 == 0) continue;
        const Corners& t = targets[r.next_u32() % targets.size()];
        const float u = r.next_float(), v = k % 4 == 1 ? 0 : (1 - u) * r.next_float();
        ray.direction = t[0] + (t[1] - t[0]) * u + (t[2] - t[0]) * v - p;
      }
    }
    std::vector<uint8_t> is_occluded(rays.size());
    tracer.occluded(rays, is_occluded);
    for (const uint8_t o : is_occluded) REQUIRE(o == 1);
  }
  CHECK(held > 3000);
  CHECK(free > 3000);
}

TEST_CASE("rooms whose walls meet are found, for any mesh; open ones are not") {
  Scene s;
  const uint32_t m = add_diffuse(s, Rgb{0.5f});
  const std::array<uint32_t, 6> walls = add_box_inside(s, m, {0, 0, 0}, {5, 4, 2.7f});
  const Vec3 inside{2.5f, 2, 1.35f}, by_the_floor{1, 1, 1e-5f}, outside{6, 2, 1},
      under{1, 1, -1e-5f};
  CHECK(is_held(s, inside));
  CHECK(is_held(s, by_the_floor));
  CHECK_FALSE(is_held(s, outside));
  CHECK_FALSE(is_held(s, under));
  SUBCASE("a free sheet and a box inside change nothing") {
    add_quad(s, m, {Vec3{1, 1, 1}, {2, 1, 1}, {2, 2, 1}, {1, 2, 1}});
    add_box_inside(s, m, {3, 1, 0}, {4, 2, 1});
    CHECK(is_held(s, inside));
    CHECK(is_held(s, by_the_floor));
  }
  SUBCASE("without a wall") {
    s.meshes[walls[3]].triangles.pop_back();
    CHECK_FALSE(is_held(s, inside));
  }
  SUBCASE("a wall that does not quite meet the others") {
    for (Vec3& p : s.meshes[walls[1]].positions) p.z = std::nextafter(p.z, 3.0f);
    CHECK_FALSE(is_held(s, inside));
  }
  SUBCASE("a wall of glass, and one with an alpha mask") {
    Material masked;
    masked.is_alpha_masked = true;
    s.meshes[walls[2]].material = add_material(s, masked);
    CHECK_FALSE(is_held(s, inside));
  }
}

TEST_CASE("axis-parallel edges may end inside other edges, oblique ones may not") {
  // a wall of four panels around a window that a shutter closes
  const auto room = [](bool has_shutter, float lean) {
    Scene s;
    const uint32_t m = add_diffuse(s, Rgb{0.5f});
    const float X = 5, Y = 4, Z = 2.7f, y0 = 1, y1 = 3.1f, z0 = 0.9f, z1 = 2.1f;
    add_quad(s, m, {Vec3{0, 0, 0}, {X, 0, 0}, {X, Y, 0}, {0, Y, 0}});
    add_quad(s, m, {Vec3{0, 0, Z}, {0, Y, Z}, {X + lean, Y, Z}, {X + lean, 0, Z}});
    add_quad(s, m, {Vec3{0, 0, 0}, {0, Y, 0}, {0, Y, Z}, {0, 0, Z}});
    add_quad(s, m, {Vec3{0, 0, 0}, {0, 0, Z}, {X + lean, 0, Z}, {X, 0, 0}});
    add_quad(s, m, {Vec3{0, Y, 0}, {X, Y, 0}, {X + lean, Y, Z}, {0, Y, Z}});
    const auto panel = [&](float ya, float yb, float za, float zb) {
      const float xa = X + lean * za / Z, xb = X + lean * zb / Z;
      add_quad(s, m, {Vec3{xa, ya, za}, {xb, ya, zb}, {xb, yb, zb}, {xa, yb, za}});
    };
    panel(0, y0, 0, Z);
    panel(y1, Y, 0, Z);
    panel(y0, y1, 0, z0);
    panel(y0, y1, z1, Z);
    if (has_shutter) panel(y0, y1, z0, z1);
    return s;
  };
  CHECK(is_held(room(true, 0), {2, 2, 1}));
  CHECK_FALSE(is_held(room(false, 0), {2, 2, 1}));
  CHECK_FALSE(is_held(room(true, 0.3f), {2, 2, 1}));
}

TEST_CASE("closedness does not depend on size and place; an empty scene has no shells") {
  for (const float size : {1e-3f, 1.0f, 2e3f})
    for (const float away : {0.0f, 1e4f}) {
      Scene s;
      const uint32_t m = add_diffuse(s, Rgb{0.5f});
      const Vec3 at{away * size, -away * size, 0};
      add_box_inside(s, m, at, at + Vec3{size, size, size});
      const ClosedShells shells(s, nullptr);
      CHECK(shells.hold(at + Vec3{0.4f, 0.6f, 0.3f} * size));
      CHECK_FALSE(shells.hold(at + Vec3{0.4f, 0.6f, 1.3f} * size));
      CHECK_FALSE(shells.hold(at));
    }
  const Scene nothing;
  CHECK(ClosedShells(nothing, nullptr).is_empty());
  CHECK_FALSE(ClosedShells().hold({0, 0, 0}));
}

TEST_CASE("a room is found beside a mesh with more triangles than are examined") {
  Random r(21);
  Scene scene;
  scene.materials.resize(1);
  add_triangles(scene, 0, bumpy_box(r, 2, {0, 0, 0}, {4, 3, 5}, 0));
  constexpr size_t many = (1 << 19) + 1;
  add_triangles(scene, 0, std::vector<Corners>(many, {Vec3{1, 1, 1}, {2, 1, 1}, {1, 2, 1}}));
  const ClosedShells shells(scene, nullptr);
  CHECK(shells.hold({2, 1.5f, 2.5f}));
  CHECK(!shells.hold({5, 1.5f, 2.5f}));
}
