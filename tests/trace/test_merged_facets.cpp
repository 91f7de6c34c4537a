// Tests that merged facets cover exactly their triangles.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/units.h"
#include "support/tessellations.h"
#include "trace/occluders.h"

using namespace troffer;
using namespace troffer::test;

namespace {

Scene scene_of(Mesh mesh) {
  Scene s;
  s.materials.resize(1);
  s.meshes.push_back(std::move(mesh));
  return s;
}

double area_of(const Quad& q) {
  const Vec3d a(q[0]);
  return 0.5 * (length(cross(Vec3d(q[1]) - a, Vec3d(q[2]) - a)) +
                length(cross(Vec3d(q[2]) - a, Vec3d(q[3]) - a)));
}

Quad triangle_of(const Mesh& m, size_t t) {
  const Triangle& c = m.triangles[t];
  return {m.positions[c[0]], m.positions[c[1]], m.positions[c[2]], m.positions[c[2]]};
}

double largest_coordinate(const Mesh& m) {
  double largest = 0;
  for (const Vec3& p : m.positions)
    for (size_t a = 0; a < 3; ++a) largest = std::max(largest, std::abs(double(p[a])));
  return largest;
}

// Returns the distance of p from a flat convex facet.
double distance_outside(const Quad& q, const Vec3d& p) {
  const Vec3d n = normalize(cross(Vec3d(q[2]) - Vec3d(q[0]), Vec3d(q[3]) - Vec3d(q[1])) +
                            cross(Vec3d(q[1]) - Vec3d(q[0]), Vec3d(q[2]) - Vec3d(q[0])));
  double most = std::abs(dot(n, p - Vec3d(q[0])));
  for (size_t i = 0; i < 4; ++i) {
    const Vec3d a(q[i]), e = Vec3d(q[(i + 1) % 4]) - a;
    if (length(e) > 0) most = std::max(most, -dot(cross(n, normalize(e)), p - a));
  }
  return most;
}

// Returns the distance of p from the triangle's edges.
double distance_to_edges(const Quad& triangle, const Vec3d& p) {
  double least = 1e30;
  for (size_t i = 0; i < 3; ++i) {
    const Vec3d a(triangle[i]), e = Vec3d(triangle[(i + 1) % 3]) - a;
    const double square = length_squared(e);
    const double at = square > 0 ? std::clamp(dot(e, p - a) / square, 0.0, 1.0) : 0;
    least = std::min(least, length(p - a - e * at));
  }
  return least;
}

// True if the segment from x to y crosses the facet.
bool is_crossed(const Quad& q, const Vec3d& x, const Vec3d& y) {
  const Vec3d d = y - x;
  int sides = 0;
  for (size_t i = 0; i < 4; ++i) {
    const Vec3d a = Vec3d(q[i]) - x, b = Vec3d(q[(i + 1) % 4]) - x;
    if (q[i] == q[(i + 1) % 4]) continue;
    sides |= dot(cross(a, b), d) > 0 ? 1 : 2;
  }
  const Vec3d n = cross(Vec3d(q[1]) - Vec3d(q[0]), Vec3d(q[2]) - Vec3d(q[0]));
  return sides != 3 && dot(n, x - Vec3d(q[0])) * dot(n, y - Vec3d(q[0])) < 0;
}

// Checks all guarantees of facets for a mesh without overlapping triangles. Returns the number of
// facets.
size_t check_facets(const Mesh& mesh, uint64_t seed) {
  const Scene scene = scene_of(mesh);
  const Occluders o(scene);
  const double ulp = 0x1p-22 * largest_coordinate(mesh);
  std::vector<double> areas(o.facet_count(), 0);
  std::vector<uint32_t> counts(o.facet_count(), 0);
  double farthest = 0, all = 0;
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Quad q = triangle_of(mesh, t);
    const double area = area_of(q);
    const uint32_t f = o.facet_of(0, t);
    CHECK((f != no_facet) == (area > 0));
    if (f == no_facet) continue;
    REQUIRE(f < o.facet_count());
    areas[f] += area;
    all += area;
    ++counts[f];
    for (const Vec3& p : q) farthest = std::max(farthest, distance_outside(o.facet(f), Vec3d(p)));
  }
  CHECK(farthest < 3 * ulp);
  double facet_area = 0;
  for (uint32_t f = 0; f < o.facet_count(); ++f) {
    const Quad& q = o.facet(f);
    double perimeter = 0;
    for (size_t i = 0; i < 4; ++i) perimeter += double(length(q[(i + 1) % 4] - q[i]));
    CHECK(counts[f] > 0);
    // its triangles lie in it without overlap, so they fill it
    CHECK(std::abs(area_of(q) - areas[f]) <= 2 * ulp * perimeter);
    facet_area += area_of(q);
  }
  CHECK(facet_area == doctest::Approx(all).epsilon(1e-5));

  // Segments through triangles and near them, except those that graze a triangle or pass an edge
  // within rounding.
  Random r(seed);
  int differences = 0, crossings = 0, tried = 0;
  for (int i = 0; i < 2000 && tried < 300; ++i) {
    const Quad q = triangle_of(mesh, r.next_u32() % mesh.triangles.size());
    const Vec3d a(q[0]), u = Vec3d(q[1]) - a, v = Vec3d(q[2]) - a;
    const Vec3d middle = a + u * (1.4 * r.next_double() - 0.3) + v * (1.4 * r.next_double() - 0.3);
    const Vec3d reach = Vec3d(sphere_from_square(r.next_vec2())) * 0.4;
    const Vec3d x = middle + reach, y = middle - reach, normal = cross(u, v);
    if (std::abs(dot(reach, normal)) <= 0.2 * length(normal)) continue;
    // rounding decides which way a needle faces
    if (length(normal) < 30 * ulp * std::max({length(u), length(v), length(u - v)})) continue;
    double clearance = 1e30;
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
      clearance = std::min(clearance, distance_to_edges(triangle_of(mesh, t), middle));
    if (clearance < 10 * ulp) continue;
    ++tried;
    int by_triangles = 0, by_facets = 0;
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
      by_triangles += is_crossed(triangle_of(mesh, t), x, y);
    for (uint32_t f = 0; f < o.facet_count(); ++f) by_facets += is_crossed(o.facet(f), x, y);
    differences += by_triangles != by_facets;
    crossings += by_triangles;
  }
  CHECK(differences == 0);
  CHECK(crossings > tried / 10);
  return o.facet_count();
}

Mesh mesh_of(const Tessellation& t, const Place& place = {}) {
  Mesh m;
  append(m, t, place);
  return m;
}

}  // namespace

TEST_CASE("a rectangle is one facet, however it is divided") {
  for (uint64_t seed = 0; seed < 60; ++seed) {
    Random r(seed);
    const Place place = seed % 4 == 0 ? Place{} : random_place(r, seed % 4 == 1 ? 1 : 20);
    const double width = 0.5 + 5 * r.next_double(), height = 0.1 + 3 * r.next_double();
    const uint32_t n = 1 + r.next_u32() % 12, m = 1 + r.next_u32() % 12;
    CAPTURE(seed);
    CHECK(check_facets(mesh_of(random_grid(r, n, m, width, height), place), seed) == 1);
    const std::vector<Vec2d> corners{{0, 0}, {width, 0}, {width, height}, {0, height}};
    CHECK(check_facets(mesh_of(random_splits(r, corners, 60, 0.2), place), seed) == 1);
    // a triangle and a trapezium
    const std::vector<Vec2d> three{{0, 0}, {width, 0.2}, {0.3, height}};
    CHECK(check_facets(mesh_of(random_splits(r, three, 60, 0.2), place), seed) == 1);
    const std::vector<Vec2d> four{{0, 0}, {width, 0}, {0.7 * width, height}, {0.1, height}};
    CHECK(check_facets(mesh_of(random_splits(r, four, 40, 0.2), place), seed) == 1);
  }
}

TEST_CASE("walls with windows and L-shapes are few facets") {
  for (uint64_t seed = 0; seed < 40; ++seed) {
    Random r(seed);
    const Place place = seed % 2 == 0 ? Place{} : random_place(r, 5);
    const auto window = [](uint32_t i, uint32_t j) { return i >= 3 && i < 7 && j >= 2 && j < 6; };
    const auto corner = [](uint32_t i, uint32_t j) { return i >= 4 && j >= 3; };
    const auto two = [](uint32_t i, uint32_t j) {
      return j >= 2 && j < 5 && ((i >= 2 && i < 4) || (i >= 6 && i < 9));
    };
    CAPTURE(seed);
    CHECK(check_facets(mesh_of(random_grid(r, 10, 8, 4, 3, window), place), seed) == 4);
    CHECK(check_facets(mesh_of(random_grid(r, 9, 7, 4, 3, corner), place), seed) == 2);
    CHECK(check_facets(mesh_of(random_grid(r, 11, 8, 4, 3, two), place), seed) == 5);
    // random holes
    const auto any = [&](uint32_t, uint32_t) { return r.next_u32() % 5 == 0; };
    const Mesh sieve = mesh_of(random_grid(r, 12, 12, 4, 3, any), place);
    CHECK(check_facets(sieve, seed) < sieve.triangles.size() / 3);
  }
}

TEST_CASE("an irregularly divided wall: about pairs of triangles at worst") {
  for (uint64_t seed = 0; seed < 60; ++seed) {
    Random r(seed);
    // a ring of triangles around a window, then random splits
    Tessellation t;
    t.points = {{0, 0}, {4, 0}, {4, 3}, {0, 3}, {1, 1}, {2.5, 1}, {2.5, 2}, {1, 2}};
    t.triangles = {{0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5},
                   {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
    CHECK(check_facets(mesh_of(t, random_place(r, 3)), seed) == 4);
    Tessellation regular = random_splits(r, {{1, 0}, {2, 0}, {3, 0.8}, {2.6, 2}, {1, 2.2}, {0, 1}},
                                         80, seed % 2 == 0 ? 0.2 : 1e-3);
    const Mesh m = mesh_of(regular, random_place(r, 3));
    CHECK(check_facets(m, seed) < 0.6 * double(m.triangles.size()));
  }
}

TEST_CASE("slivers and needles") {
  for (uint64_t seed = 0; seed < 60; ++seed) {
    Random r(seed);
    const double height = seed % 2 == 0 ? 1e-3 : 1e-4;
    CAPTURE(seed);
    const std::vector<Vec2d> corners{{0, 0}, {3, 0}, {3, height}, {0, height}};
    const Mesh wire = mesh_of(random_grid(r, 20, 1, 3, height), random_place(r, 2));
    CHECK(check_facets(wire, seed) <= 20);
    check_facets(mesh_of(random_splits(r, corners, 40, 1e-3), random_place(r, 2)), seed);
    const std::vector<Vec2d> square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    check_facets(mesh_of(random_splits(r, square, 80, 1e-4), random_place(r, 2)), seed);
  }
}

TEST_CASE("a tessellated box is six facets and stays closed") {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    Random r(seed);
    constexpr uint32_t n = 5;
    const Place place = random_place(r, 3);
    Mesh m;
    // six sides of n × n squares; vertices of neighbours have identical coordinates
    for (uint32_t side = 0; side < 6; ++side) {
      const auto base = uint32_t(m.positions.size());
      for (uint32_t j = 0; j <= n; ++j)
        for (uint32_t i = 0; i <= n; ++i) {
          double p[3];
          p[side / 2] = side % 2 == 0 ? 0 : 1;
          p[(side / 2 + 1) % 3] = double(side % 2 == 0 ? j : i) / n;
          p[(side / 2 + 2) % 3] = double(side % 2 == 0 ? i : j) / n;
          m.positions.push_back(place.at({p[0], p[1]}, p[2]));
        }
      for (uint32_t j = 0; j < n; ++j)
        for (uint32_t i = 0; i < n; ++i) {
          const uint32_t a = base + j * (n + 1) + i;
          m.triangles.push_back({a, a + 1, a + n + 2});
          m.triangles.push_back({a, a + n + 2, a + n + 1});
        }
    }
    CHECK(check_facets(m, seed) == 6);
    const Occluders whole(scene_of(m));
    for (uint32_t f = 0; f < 6; ++f) {
      CHECK(whole.component_of(f).is_closed);
      for (const Vec3& p : m.positions) {
        const Box& b = whole.component_of(f).bounds;
        CHECK(p.x >= b.lower.x);
        CHECK(p.x <= b.upper.x);
      }
    }
    // without one triangle, facets cover less and the surface is open
    m.triangles.pop_back();
    const Occluders open(scene_of(m));
    CHECK(open.facet_count() > 6);
    CHECK_FALSE(open.component_of(0).is_closed);
  }
}

TEST_CASE("facets that must not merge stay separate") {
  Random r(1);
  Mesh m = mesh_of(random_grid(r, 4, 4, 1, 1));
  // the same sheet twice, in one mesh and in two
  Mesh twice = m;
  append(twice, random_grid(r, 4, 4, 1, 1), Place{});
  CHECK(Occluders(scene_of(twice)).facet_count() >= 2);
  Scene two = scene_of(m);
  two.materials.resize(2);
  two.meshes.push_back(mesh_of(random_grid(r, 3, 2, 1, 1)));
  two.meshes[1].material = 1;
  const Occluders o(two);
  CHECK(o.facet_count() == 2);
  CHECK(o.facet_of(0, 0) != o.facet_of(1, 0));
  // exact duplicates of triangles, and their reversed copies
  Mesh copies = m;
  for (const Triangle& t : m.triangles) copies.triangles.push_back(t);
  CHECK(Occluders(scene_of(copies)).facet_count() == copies.triangles.size());
  Mesh both = m;
  for (const Triangle& t : m.triangles) both.triangles.push_back({t[0], t[2], t[1]});
  CHECK(Occluders(scene_of(both)).facet_count() >= 2);
  // a cylinder whose neighbouring faces are nearly coplanar
  Mesh round;
  constexpr uint32_t n = 20000;
  for (uint32_t i = 0; i < n; ++i) {
    const double angle = 2 * pi * i / n;
    for (const float z : {0.0f, 1.0f})
      round.positions.push_back({float(std::cos(angle)), float(std::sin(angle)), z});
  }
  for (uint32_t i = 0; i < n; ++i) {
    const uint32_t a = 2 * i, b = 2 * ((i + 1) % n);
    round.triangles.push_back({a, b, b + 1});
    round.triangles.push_back({a, b + 1, a + 1});
  }
  const Occluders fine(scene_of(round));
  for (uint32_t t = 0; t < round.triangles.size(); ++t)
    for (const uint32_t v : round.triangles[t])
      CHECK(distance_outside(fine.facet(fine.facet_of(0, t)), Vec3d(round.positions[v])) < 5e-7);
}

TEST_CASE("large meshes: one facet for 200 000 triangles") {
  Random r(3);
  const Mesh m = mesh_of(random_grid(r, 400, 250, 10, 6), random_place(r, 10));
  CHECK(Occluders(scene_of(m)).facet_count() == 1);
  const auto window = [](uint32_t i, uint32_t j) { return i > 100 && i < 200 && j > 80 && j < 90; };
  const Mesh wall = mesh_of(random_grid(r, 400, 250, 10, 6, window), random_place(r, 10));
  CHECK(Occluders(scene_of(wall)).facet_count() == 4);
}
