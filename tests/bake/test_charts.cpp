// Charts of arbitrary meshes do not overlap themselves or share places.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "bake/atlas.h"
#include "bake/charts.h"
#include "bake/flat_triangles.h"
#include "bake/packing.h"
#include "base/random.h"
#include "support/instanced_scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

FlatTriangle placed(const ChartedMesh& m, uint32_t triangle) {
  const Triangle& t = m.mesh.triangles[triangle];
  return {Vec2d(m.places[t[0]]), Vec2d(m.places[t[1]]), Vec2d(m.places[t[2]])};
}

double area_in_space(const Mesh& m, uint32_t triangle) {
  const Triangle& t = m.triangles[triangle];
  const Vec3d p(m.positions[t[0]]);
  return length(cross(Vec3d(m.positions[t[1]]) - p, Vec3d(m.positions[t[2]]) - p)) / 2;
}

// Checks that every triangle with area is in one chart, inside its rectangle, not much shrunk, and
// overlaps no other: all pairs are tested.
void check_charts(const Mesh& mesh) {
  const ChartedMesh m = charted(mesh);
  REQUIRE(m.mesh.triangles.size() == mesh.triangles.size());
  std::vector<int> charts_of(mesh.triangles.size(), 0);
  size_t over = 0, outside = 0, shrunk = 0;
  for (const Chart& c : m.charts) {
    CHECK(c.size.x >= c.size.y * 0.999f);
    for (size_t i = 0; i < c.triangles.size(); ++i) {
      ++charts_of[c.triangles[i]];
      const FlatTriangle t = placed(m, c.triangles[i]);
      for (const Vec2d& p : t) {
        const double slack = 1e-5 * (1 + double(c.size.x));
        outside += !(p.x >= -slack && p.y >= -slack && p.x <= double(c.size.x) + slack &&
                     p.y <= double(c.size.y) + slack);
      }
      const double area = area_in_space(m.mesh, c.triangles[i]);
      shrunk += !(std::abs(doubled_area(t)) / 2 > 0.74 * area - 1e-6);
      for (size_t k = 0; k < i; ++k) over += overlap(t, placed(m, c.triangles[k]));
    }
  }
  CHECK(over == 0);
  CHECK(outside == 0);
  CHECK(shrunk == 0);
  size_t alone = 0;
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const bool is_sound = area_in_space(mesh, t) > 1e-20;
    if (is_sound) CHECK(charts_of[t] == 1);
    alone += charts_of[t] == 0;
    for (size_t k = 0; k < 3; ++k) {
      const Vec3 &a = m.mesh.positions[m.mesh.triangles[t][k]],
                 &b = mesh.positions[mesh.triangles[t][k]];
      CHECK((a == b || !is_finite(b)));
    }
  }
  CHECK(alone == m.degenerate);
}

Mesh soup(size_t triangles, uint64_t seed) {
  Random random(seed);
  Mesh m;
  const auto coordinate = [&] { return std::floor(random.next_float() * 4) / 2; };
  for (size_t i = 0; i < triangles; ++i) {
    for (int k = 0; k < 3; ++k) m.positions.push_back({coordinate(), coordinate(), coordinate()});
    const auto n = uint32_t(m.positions.size());
    m.triangles.push_back({n - 3, n - 2, n - 1});
  }
  return m;
}

}  // namespace

TEST_CASE("a box has six charts the size of its sides") {
  Scene s;
  add_diffuse(s, Rgb{0.5f});
  add_box_inside(s, 0, {0, 0, 0}, {3, 2, 1});
  Mesh box;
  for (const Mesh& side : s.meshes) {
    const auto first = uint32_t(box.positions.size());
    box.positions.insert(box.positions.end(), side.positions.begin(), side.positions.end());
    for (const Triangle& t : side.triangles)
      box.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  check_charts(box);
  const ChartedMesh m = charted(box);
  REQUIRE(m.charts.size() == 6);
  double area = 0;
  for (const Chart& c : m.charts) area += double(c.size.x) * double(c.size.y);
  CHECK(area == doctest::Approx(2 * (6 + 3 + 2)));
}

TEST_CASE("charts of curved, torn, doubled and broken meshes do not overlap") {
  check_charts(dented_ball(0, 24));
  for (const uint64_t seed : {1, 2, 3}) check_charts(soup(300, seed));
  Mesh doubled = dented_ball(0, 8);
  const std::vector<Triangle> once = doubled.triangles;
  for (const Triangle& t : once) {  // each twice more: once identical, once flipped
    doubled.triangles.push_back(t);
    doubled.triangles.push_back({t[0], t[2], t[1]});
  }
  check_charts(doubled);
  // A nearly flat ramp that winds around three times, so that its turns lie above each other.
  Mesh ramp;
  for (int i = 0; i <= 90; ++i) {
    const float phi = float(i) * 0.2094f;
    for (const float r : {1.0f, 2.0f})
      ramp.positions.push_back({r * std::cos(phi), r * std::sin(phi), 0.01f * float(i)});
    const auto n = uint32_t(ramp.positions.size());
    if (i == 0) continue;
    ramp.triangles.push_back({n - 4, n - 3, n - 1});
    ramp.triangles.push_back({n - 4, n - 1, n - 2});
  }
  check_charts(ramp);
  CHECK(charted(ramp).charts.size() >= 3);
}

TEST_CASE("degenerate triangles get no chart") {
  Mesh m;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  m.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {nan, 0, 0}, {2, 0, 0}, {1e30f, 1e30f, 0}};
  m.triangles = {{0, 1, 2}, {0, 0, 1}, {0, 1, 4}, {0, 1, 3}, {5, 5, 5}};
  const ChartedMesh c = charted(m);
  CHECK(c.charts.size() == 1);
  CHECK(c.degenerate == 4);
  CHECK(c.mesh.triangles.size() == m.triangles.size());
  CHECK(charted(Mesh{}).charts.empty());
}

TEST_CASE("rectangles are packed without overlap, groups on one page each") {
  Random random(5);
  for (const int size : {64, 257}) {
    std::vector<PackGroup> groups(40);
    for (PackGroup& g : groups)
      for (int i = 0; i < 6; ++i)
        g.sizes.push_back({1 + int(random.next_float() * 30), 1 + int(random.next_float() * 20)});
    const int pages = pack(groups, size, 64);
    REQUIRE(pages > 0);
    std::vector<std::vector<int>> taken(size_t(pages), std::vector<int>(size_t(size * size), 0));
    for (const PackGroup& g : groups)
      for (size_t i = 0; i < g.sizes.size(); ++i) {
        REQUIRE(g.at[i].x + g.sizes[i].width <= size);
        REQUIRE(g.at[i].y + g.sizes[i].height <= size);
        for (int y = 0; y < g.sizes[i].height; ++y)
          for (int x = 0; x < g.sizes[i].width; ++x)
            ++taken[size_t(g.page)][size_t((g.at[i].y + y) * size + g.at[i].x + x)];
      }
    for (const auto& page : taken) CHECK(*std::max_element(page.begin(), page.end()) <= 1);
  }
  std::vector<PackGroup> wide{{{{65, 1}}, -1, {}}};
  CHECK(pack(wide, 64, 64) == 0);
}

TEST_CASE("a second set of texture coordinates is used only if it can hold a lightmap") {
  Mesh m;
  m.positions = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  m.triangles = {{0, 1, 2}, {0, 2, 3}};
  ChartedMesh out;
  REQUIRE(chart_of_uvs(m, {{0, 0}, {0.5f, 0}, {0.5f, 0.5f}, {0, 0.5f}}, out));
  CHECK(double(out.charts[0].size.x) == doctest::Approx(2));
  CHECK(!chart_of_uvs(m, {{0, 0}, {1.5f, 0}, {1, 1}, {0, 1}}, out));      // outside
  CHECK(!chart_of_uvs(m, {{0, 0}, {1, 0}, {0.5f, 1}, {1, 0.01f}}, out));  // overlapping
  CHECK(!chart_of_uvs(m, {{0, 0}, {1, 0}, {0.5f, 0}, {0, 1}}, out));      // without area
}
