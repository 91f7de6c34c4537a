// Merging of convex polygons. tests/trace covers walls and other surfaces, tests/shadow covers
// sources.
#include "base/merge_polygons.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "base/edge_table.h"
#include "base/random.h"
#include "base/units.h"

using namespace troffer;

TEST_CASE("weld: equal positions get the same number") {
  const std::vector<Vec3> p{{0, 1, 2}, {1, 1, 2}, {-0.0f, 1, 2}, {0, 1, 2}, {1, 1, 2.0000002f}};
  const std::vector<uint32_t> w = weld(p);
  CHECK(w[0] == w[2]);
  CHECK(w[0] == w[3]);
  CHECK(w[0] != w[1]);
  CHECK(w[1] != w[4]);
}

TEST_CASE("edges of polygons are complete and in order") {
  Random r(1);
  PolygonList list;
  std::vector<std::tuple<uint32_t, uint32_t, uint32_t, bool>> expected;
  for (uint32_t i = 0; i < 500; ++i) {
    std::vector<uint32_t> c(3 + r.next_u32() % 3);
    for (uint32_t& v : c) v = r.next_u32() % 40;
    list.add(c);
    for (size_t k = 0; k < c.size(); ++k) {
      const uint32_t from = c[k], to = c[(k + 1) % c.size()];
      if (from != to) expected.emplace_back(std::min(from, to), std::max(from, to), i, from < to);
    }
  }
  const std::vector<PolygonEdge> edges = sorted_edges(list, 40);
  REQUIRE(edges.size() == expected.size());
  std::vector<std::tuple<uint32_t, uint32_t, uint32_t, bool>> found;
  for (const PolygonEdge& e : edges) found.emplace_back(e.low, e.high, e.polygon, e.is_forward);
  CHECK(std::is_sorted(found.begin(), found.end(), [](const auto& a, const auto& b) {
    return std::tie(std::get<0>(a), std::get<1>(a), std::get<2>(a)) <
           std::tie(std::get<0>(b), std::get<1>(b), std::get<2>(b));
  }));
  std::sort(found.begin(), found.end());
  std::sort(expected.begin(), expected.end());
  CHECK(found == expected);
}

TEST_CASE("the edge table grows, removes edges, and handles edges that many polygons share") {
  EdgeTable t;
  t.clear(1);
  for (uint32_t i = 0; i < 3000; ++i) t.insert(i, i * 7 + 1, i);
  for (uint32_t i = 0; i < 3000; ++i) CHECK(t.find(i, i * 7 + 1) == i);
  CHECK(t.find(1, 0) == EdgeTable::none);
  t.erase(5, 36);
  CHECK(t.find(5, 36) == EdgeTable::none);
  t.insert(5, 36, 9);
  CHECK(t.find(5, 36) == 9);
  t.insert(5, 36, 10);
  t.erase(5, 36);
  CHECK(t.find(5, 36) == EdgeTable::many);
}

TEST_CASE("merged polygons have a limited number of corners and keep their front") {
  // one fan around the centre of a regular polygon, and one around a corner
  for (uint32_t n = 3; n <= 24; ++n)
    for (const size_t most : {size_t(4), size_t(8), size_t(11), size_t(12)})
      for (const bool about_corner : {false, true}) {
        std::vector<Vec3> p;
        for (uint32_t i = 0; i < n; ++i)
          p.push_back({float(std::cos(2 * pi * i / n)), float(std::sin(2 * pi * i / n)), 3});
        p.push_back({0, 0, 3});
        PolygonList list;
        for (uint32_t i = 0; i < n; ++i) {
          const std::array<uint32_t, 3> t{about_corner ? 0 : n, i, (i + 1) % n};
          if (!about_corner || (i > 0 && i + 1 < n)) list.add(t);
        }
        const MergedPolygons m = merge_polygons(p, list, sorted_edges(list, p.size()), most);
        CAPTURE(n);
        CAPTURE(most);
        CHECK(m.of_piece.size() == list.size());
        if (n <= most) CHECK(m.polygons.size() == 1);
        CHECK(m.polygons.size() <= list.size() * 2 / 3 + 1);
        double area = 0;
        for (size_t i = 0; i < m.polygons.size(); ++i) {
          const auto c = m.polygons[i];
          CHECK(c.size() <= most);
          for (size_t k = 1; k + 1 < c.size(); ++k) {
            const double twice = double(cross(p[c[k]] - p[c[0]], p[c[k + 1]] - p[c[0]]).z);
            CHECK(twice > -1e-6);
            area += twice / 2;
          }
        }
        CHECK(area == doctest::Approx(0.5 * n * std::sin(2 * pi / n)).epsilon(1e-6));
      }
}

TEST_CASE("quadrilaterals and polygons merge too; empty input stays empty") {
  // three squares in a row, the middle one as two triangles
  const std::vector<Vec3> p{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0},
                            {0, 1, 0}, {1, 1, 0}, {2, 1, 0}, {3, 1, 0}};
  PolygonList list;
  list.add(std::array<uint32_t, 4>{0, 1, 5, 4});
  list.add(std::array<uint32_t, 3>{1, 2, 6});
  list.add(std::array<uint32_t, 3>{1, 6, 5});
  list.add(std::array<uint32_t, 4>{2, 3, 7, 6});
  list.add(std::array<uint32_t, 3>{0, 1, 1});  // no area
  MergedPolygons m = merge_polygons(p, list, sorted_edges(list, p.size()), 4);
  CHECK(m.polygons.size() == 1);
  CHECK(m.polygons[0].size() == 4);
  CHECK(m.of_piece == std::vector<uint32_t>{0, 0, 0, 0, no_polygon});
  m = merge_polygons({}, {}, {}, 4);
  CHECK(m.polygons.size() == 0);
}

TEST_CASE("edges collected in parts equal the sorted list and merge identically") {
  // A rough grid, flat in one half, with more edges than one part holds.
  constexpr uint32_t n = 480;
  std::vector<Vec3> p;
  PolygonList list;
  Random r(3);
  for (uint32_t y = 0; y <= n; ++y)
    for (uint32_t x = 0; x <= n; ++x)
      p.push_back({float(x), float(y), x < n / 2 ? 0.0f : r.next_float()});
  for (uint32_t y = 0; y < n; ++y)
    for (uint32_t x = 0; x < n; ++x) {
      const uint32_t a = y * (n + 1) + x;
      list.add(std::array<uint32_t, 3>{a, a + 1, a + n + 2});
      list.add(std::array<uint32_t, 3>{a, a + n + 2, a + n + 1});
    }
  const std::vector<PolygonEdge> sorted = sorted_edges(list, p.size());
  REQUIRE(sorted.size() > (size_t(1) << 20));
  size_t at = 0, wrong = 0;
  const MergedPolygons parts = merge_polygons(p, list, 4, [&](std::span<const PolygonEdge> edges) {
    for (const PolygonEdge& e : edges) {
      const PolygonEdge& f = sorted[at++];
      if (e.low != f.low || e.high != f.high || e.polygon != f.polygon ||
          e.is_forward != f.is_forward || e.low != edges[0].low || e.high != edges[0].high)
        ++wrong;
    }
  });
  CHECK(at == sorted.size());
  CHECK(wrong == 0);
  const MergedPolygons whole = merge_polygons(p, list, sorted, 4);
  CHECK(parts.of_piece == whole.of_piece);
  CHECK(parts.polygons.corners == whole.polygons.corners);
  CHECK(whole.polygons.size() < list.size() * 3 / 4);
}
