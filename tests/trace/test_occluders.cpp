#include <doctest/doctest.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <thread>

#include "base/parallel.h"
#include "base/random.h"
#include "base/warp.h"
#include "trace/occluders.h"
#include "trace/surface.h"
#include "trace/tracer.h"

using namespace troffer;

namespace {

Vec3 random_point(Random& r) {
  const float x = r.next_float(), y = r.next_float();
  return {x, y, r.next_float()};
}

Scene soup(uint64_t seed, int triangles) {
  Random r(seed);
  Scene s;
  s.materials.resize(1);
  Mesh m;
  for (int i = 0; i < triangles; ++i) {
    const auto base = uint32_t(m.positions.size());
    const Vec3 p = random_point(r);
    const float size = r.next_float() < 0.1f ? 1.0f : 0.05f;
    m.positions.push_back(p);
    m.positions.push_back(p + (random_point(r) - Vec3{0.5f, 0.5f, 0.5f}) * size);
    m.positions.push_back(p + (random_point(r) - Vec3{0.5f, 0.5f, 0.5f}) * (size * 0.02f));
    m.triangles.push_back({base, base + 1, base + 2});
  }
  s.meshes.push_back(m);
  return s;
}

// Adds a box of 12 triangles around a centre.
void add_box(Mesh& m, const Vec3& c, float h) {
  const auto base = uint32_t(m.positions.size());
  for (int i = 0; i < 8; ++i)
    m.positions.push_back(
        c + Vec3{(i & 1) != 0 ? h : -h, (i & 2) != 0 ? h : -h, (i & 4) != 0 ? h : -h});
  constexpr uint32_t quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& q : quads) {
    m.triangles.push_back({base + q[0], base + q[1], base + q[2]});
    m.triangles.push_back({base + q[0], base + q[2], base + q[3]});
  }
}

Plane plane_through(const Vec3& p, const Vec3& normal) {
  const Vec3 n = normalize(normal);
  return {n, dot(n, p)};
}

bool is_inside(const Vec3& p, const std::vector<Plane>& planes, float margin) {
  return std::all_of(planes.begin(), planes.end(), [&](const Plane& plane) {
    return dot(plane.normal, p) <= plane.distance - margin;
  });
}

}  // namespace

TEST_CASE("gathering never misses a facet with a point inside the planes") {
  size_t expected = 0, gathered = 0;
  for (uint64_t seed = 0; seed < 60; ++seed) {
    const Scene scene = soup(seed, seed % 3 == 0 ? 3 : 2000);
    const Occluders occluders(scene);
    CHECK(occluders.facet_count() <= scene.meshes[0].triangles.size());
    Random r(seed + 99);
    for (int trial = 0; trial < 20; ++trial) {
      std::vector<Plane> planes;
      const Vec3 centre = random_point(r);
      const auto count = size_t(1 + r.next_float() * 20);
      for (size_t i = 0; i < count; ++i) {
        const Vec3 n = sphere_from_square(r.next_vec2());
        planes.push_back(plane_through(centre + n * (0.3f * r.next_float()), n));
      }
      Occluders::Found found;
      occluders.gather(planes, 1000000, found);
      CHECK(found.is_complete);
      const std::set<uint32_t> ids(found.facets.begin(), found.facets.end());
      CHECK(ids.size() == found.facets.size());
      gathered += ids.size();
      for (uint32_t f = 0; f < occluders.facet_count(); ++f) {
        const Quad& q = occluders.facet(f);
        bool has_point_inside = false;
        for (int k = 0; k < 20 && !has_point_inside; ++k) {
          const Vec2 b = triangle_from_square(r.next_vec2());
          has_point_inside =
              is_inside(q[0] + (q[1] - q[0]) * b.x + (q[2] - q[0]) * b.y, planes, 1e-6f);
        }
        if (!has_point_inside) continue;
        ++expected;
        CHECK(ids.count(f) == 1);
      }
      // an early stop keeps the found facets and marks the list as incomplete
      Occluders::Found some;
      occluders.gather(planes, ids.size() / 2, some);
      CHECK(some.is_complete == ids.empty());
      CHECK(some.facets.size() == ids.size() / 2);
      for (const uint32_t f : some.facets) CHECK(ids.count(f) == 1);
    }
  }
  CHECK(expected > 10000);
  CHECK(gathered < 5 * expected);
}

namespace {

// Returns all facets in tree order, and the number of nodes.
Occluders::Found all_of(const Occluders& occluders) {
  Occluders::Found found;
  occluders.gather({}, occluders.facet_count(), found);
  return found;
}

// Returns many facets in few places, where all splits are equally good.
Scene piles() {
  Scene s = soup(3, 30'000);
  Mesh& m = s.meshes[0];
  for (size_t i = 0; i < m.positions.size(); ++i)
    if (i / 3 % 2 == 0) m.positions[i] = m.positions[i % 30];
  return s;
}

double seconds_of(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

// Waits until other threads of the process are idle.
void wait_for_other_threads() {
  for (int i = 0; i < 500; ++i) {
    const double all = seconds_of(CLOCK_PROCESS_CPUTIME_ID),
                 own = seconds_of(CLOCK_THREAD_CPUTIME_ID);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const double by_all = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - all,
                 by_own = seconds_of(CLOCK_THREAD_CPUTIME_ID) - own;
    if (by_all - by_own < 1e-4) return;
  }
}

}  // namespace

TEST_CASE("meshes elsewhere change no facet, however many triangles they have") {
  const Scene few = soup(7, 2000);
  Scene many = few;
  constexpr int others = (1 << 18) + 1;
  many.meshes.push_back(soup(8, others).meshes[0]);
  for (Vec3& p : many.meshes[1].positions) p.x += 10;
  const Occluders small(few), large(many);
  REQUIRE(large.facet_count() > others);
  for (uint32_t f = 0; f < small.facet_count(); ++f) CHECK(small.facet(f) == large.facet(f));
  for (uint32_t t = 0; t < 2000; ++t) CHECK(small.facet_of(0, t) == large.facet_of(0, t));
  Random r(9);
  size_t gathered = 0;
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Plane> planes{{{1, 0, 0}, 5}};
    for (int i = 0; i < 6; ++i) {
      const Vec3 n = sphere_from_square(r.next_vec2());
      planes.push_back(plane_through(random_point(r) + n * 0.2f, n));
    }
    const auto ids = [&](const Occluders& occluders) {
      Occluders::Found found;
      occluders.gather(planes, 1000000, found);
      CHECK(found.is_complete);
      std::sort(found.facets.begin(), found.facets.end());
      return found.facets;
    };
    const std::vector<uint32_t> expected = ids(small);
    CHECK(ids(large) == expected);
    gathered += expected.size();
  }
  CHECK(gathered > 1000);
}

TEST_CASE("the tree is the same for any number of threads") {
  const Scene scene = piles();
  Occluders::Found one;
  run_on_one_thread([&] { one = all_of(Occluders(scene)); });
  CHECK(one.facets.size() > 15'000);
  for (const int threads : {2, 5, 8})
    parallel_for(1, threads, [&](size_t) {
      const Occluders::Found many = all_of(Occluders(scene));
      CHECK(many.facets == one.facets);
      CHECK(many.visited_nodes == one.visited_nodes);
    });
}

TEST_CASE("occluders are built only on the thread that asks for them") {
  const Scene scene = soup(3, 100'000);
  wait_for_other_threads();
  // clocks of a busy machine may be off by some percent
  double least = 1;
  for (int i = 0; i < 5; ++i) {
    const double all = seconds_of(CLOCK_PROCESS_CPUTIME_ID),
                 own = seconds_of(CLOCK_THREAD_CPUTIME_ID);
    const Occluders occluders(scene);
    const double by_all = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - all;
    const double by_own = seconds_of(CLOCK_THREAD_CPUTIME_ID) - own;
    CHECK(occluders.facet_count() > 90'000);
    least = std::min(least, (by_all - by_own) / by_all);
  }
  CHECK(least < 0.02);
}

TEST_CASE("every hit lies on the facet of its triangle") {
  const Scene scene = soup(5, 3000);
  const Occluders occluders(scene);
  const Tracer tracer(scene);
  Random r(1);
  size_t hits = 0;
  for (int i = 0; i < 20000; ++i) {
    Ray ray;
    ray.origin = random_point(r);
    ray.direction = sphere_from_square(r.next_vec2());
    Hit hit;
    tracer.closest({&ray, 1}, {&hit, 1});
    if (!hit.is_valid()) continue;
    ++hits;
    const uint32_t id = occluders.facet_of(hit.geometry, hit.primitive);
    REQUIRE(id != no_facet);
    const Quad& q = occluders.facet(id);
    const Surface s = surface_at(scene, ray, hit);
    const Vec3d n = normalize(cross(Vec3d(q[1]) - Vec3d(q[0]), Vec3d(q[2]) - Vec3d(q[0])));
    CHECK(std::abs(dot(n, Vec3d(s.position) - Vec3d(q[0]))) < 1e-6);
  }
  CHECK(hits > 2000);
}

TEST_CASE("triangles of a flat face become one quadrilateral, others stay") {
  Scene s;
  s.materials.resize(1);
  Mesh m;
  add_box(m, {0, 0, 0}, 1);
  s.meshes.push_back(m);
  const Occluders box(s);
  CHECK(box.facet_count() == 6);
  for (uint32_t i = 0; i < 12; ++i) CHECK(box.facet_of(0, i) != no_facet);
  for (uint32_t f = 0; f < 6; ++f) {
    CHECK_FALSE(is_triangle(box.facet(f)));
    CHECK(box.component_of(f).is_closed);
    // orientation is kept: normals point outwards
    const Quad& q = box.facet(f);
    CHECK(dot(cross(q[1] - q[0], q[2] - q[0]), q[0] + q[2]) > 0);
  }
  // bent along the diagonal by more than rounding
  Scene bent;
  bent.materials.resize(1);
  Mesh b;
  b.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 1e-5f}, {0, 1, 0}};
  b.triangles = {{0, 1, 2}, {0, 2, 3}};
  bent.meshes.push_back(b);
  CHECK(Occluders(bent).facet_count() == 2);
  // coplanar, but not convex together
  b.positions = {{0, 0, 0}, {1, 0, 0}, {0.1f, 0.1f, 0}, {0, 1, 0}};
  bent.meshes[0] = b;
  CHECK(Occluders(bent).facet_count() == 2);
}

TEST_CASE("closed surfaces are distinguished from open ones") {
  Scene s;
  s.materials.resize(1);
  Mesh m;
  add_box(m, {0, 0, 0}, 1);
  add_box(m, {5, 0, 0}, 1);
  m.triangles.pop_back();  // the second box has a hole
  s.meshes.push_back(m);
  const Occluders o(s);
  CHECK(o.component_of(o.facet_of(0, 0)).is_closed);
  CHECK(o.component_of(o.facet_of(0, 0)).bounds.upper.x == 1);
  CHECK_FALSE(o.component_of(o.facet_of(0, 12)).is_closed);
  CHECK(o.component_of(o.facet_of(0, 12)).bounds.lower.x == 4);
}

TEST_CASE("degenerate meshes: no area, duplicates, no triangles, nothing at all") {
  Scene s;
  CHECK(Occluders(s).facet_count() == 0);
  s.materials.resize(1);
  Mesh m;
  m.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}};
  m.triangles = {{0, 1, 2}, {0, 0, 1}, {0, 1, 3}, {0, 1, 3}, {3, 1, 0}};
  s.meshes.push_back(m);
  s.meshes.push_back(Mesh{});
  const Occluders o(s);
  CHECK(o.facet_count() == 3);
  CHECK(o.facet_of(0, 0) == no_facet);
  CHECK(o.facet_of(0, 1) == no_facet);
  CHECK(o.facet_of(0, 3) != no_facet);
  CHECK(o.facet_of(7, 0) == no_facet);
}

TEST_CASE("shapes that are not facets are reported: spheres and disks stay exact") {
  Scene s;
  s.materials.resize(2);
  s.materials[1].is_alpha_masked = true;
  Mesh leaf;
  leaf.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  leaf.triangles = {{0, 1, 2}};
  leaf.material = 1;
  s.meshes.push_back(leaf);
  s.spheres.push_back({{3, 0, 0}, 0.5f, false, 0, no_light});
  s.disks.push_back({{6, 0, 0}, {0, 0, 1}, 0.5f, 0, no_light});
  const Occluders o(s);
  CHECK(o.facet_count() == 0);
  for (const float x : {0.2f, 3.4f, 6.4f, 9.0f}) {
    const std::vector<Plane> planes{{{1, 0, 0}, x + 0.01f}, {{-1, 0, 0}, -x + 0.01f}};
    Occluders::Found found;
    o.gather(planes, 100, found);
    CHECK(found.others == (x < 1 ? 1 : 0));
    REQUIRE(found.rounds.size() == (x > 1 && x < 9 ? 1 : 0));
    if (x > 1 && x < 9) CHECK(found.rounds[0].is_disk() == (x > 6));
    CHECK(found.is_complete);
  }
}
