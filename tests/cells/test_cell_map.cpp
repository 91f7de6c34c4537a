#include <doctest/doctest.h>

#include <algorithm>

#include "base/random.h"
#include "base/warp.h"
#include "cells/cell_map.h"
#include "support/scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

CellHit on_floor(float x, float y) {
  return {{x, y, 0}, {0, 0, 1}, {0, 0, 1}, 1e-5f};
}

// A floor of 4 × 4 m. A wall without thickness at x = 0.33 parts it in two.
Scene parted_floor() {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  add_quad(s, grey, {Vec3{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
  add_quad(s, grey, {Vec3{0.33f, -2, 0}, {0.33f, 2, 0}, {0.33f, 2, 2}, {0.33f, -2, 2}});
  return s;
}

}  // namespace

TEST_CASE("hits in one voxel share a cell unless side, plane or distance differ") {
  Scene s;
  add_quad(s, add_diffuse(s, Rgb{0.5f}), {Vec3{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
  const Tracer tracer(s);
  CellMap map(tracer, 1);
  CHECK(map.find(on_floor(0.1f, 0.1f), 5) == no_cell);
  const uint32_t cell = map.add(on_floor(0.1f, 0.1f), 5);
  CHECK(map.add(on_floor(0.2f, 0.3f), 5) == cell);
  CHECK(map.find(on_floor(0.3f, 0.2f), 5) == cell);
  CHECK(map.hits(cell).size() == 2);
  CHECK(map.find(on_floor(1.5f, 0.1f), 5) == no_cell);
  CHECK(map.find(on_floor(0.1f, 0.1f), 1) == no_cell);  // near hits have cells of half the size
  CellHit below = on_floor(0.1f, 0.1f);
  below.normal = below.horizon = {0, 0, -1};
  CHECK(map.find(below, 5) == no_cell);
  CellHit shelf = on_floor(0.1f, 0.1f);
  shelf.position.z = 0.1f;
  CHECK(map.find(shelf, 5) == no_cell);
  CHECK(map.add(shelf, 5) != cell);
  CHECK(map.find(on_floor(0.3f, 0.2f), 5) == cell);
}

TEST_CASE("distant hits use larger cells, the same for all equally distant receivers") {
  Scene s;
  add_quad(s, add_diffuse(s, Rgb{0.5f}), {Vec3{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
  const Tracer tracer(s);
  constexpr float size = 0.01f;
  CellMap map(tracer, size);
  size_t before = 0;
  std::vector<size_t> cells;
  for (const float sizes : {2.0f, 4.0f, 60.0f, 70.0f, 120.0f, 140.0f, 300.0f, 1e30f}) {
    Random here(6);
    for (int i = 0; i < 20000; ++i) {
      const CellHit hit = on_floor(here.next_float(), here.next_float());
      const uint32_t cell = map.add(hit, sizes * size);
      CHECK(map.find(hit, sizes * size) == cell);
    }
    // Cells for near rays do not serve rays from afar; otherwise the finest one is found.
    CHECK((map.find_from_afar(on_floor(0.5f, 0.5f)) == no_cell) == (sizes == 2.0f));
    cells.push_back(map.size() - before);
    before = map.size();
  }
  const auto about = [](double n) { return doctest::Approx(n).epsilon(0.06); };
  CHECK(double(cells[1]) == about(8647));  // 20 000 random hits meet this many of 10 000
  CHECK(cells[0] > cells[1]);
  CHECK(cells[2] == 0);
  CHECK(double(cells[3]) == about(2601));
  CHECK(cells[4] == 0);
  CHECK(double(cells[5]) == about(676));
  CHECK(double(cells[6]) == about(169));
  CHECK(cells[7] == 1);
  CellMap far(tracer, size);
  const uint32_t only = far.add(on_floor(0.5f, 0.5f), 200 * size);
  CHECK(far.find(on_floor(0.5f, 0.5f), far.near()) == no_cell);
  CHECK(far.find_from_afar(on_floor(0.5f, 0.5f)) == only);
}

TEST_CASE("cells are halved repeatedly where light is uneven, up to a limit") {
  Scene s;
  add_quad(s, add_diffuse(s, Rgb{0.5f}), {Vec3{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
  const Tracer tracer(s);
  CellMap map(tracer, 1);
  // Halves cells as for a lamp at the origin: no cell is wider than its distance from there.
  map.halve_where([](const CellOutline& cell, bool) {
    const Vec3 d = (cell.corners[0] + cell.corners[2]) * 0.5f;
    CHECK(cell.normal == Vec3{0, 0, 1});
    CHECK(cell.offset == 1e-5f);
    return length(cell.corners[1] - cell.corners[0]) > length(d);
  });
  Random random(4);
  for (int i = 0; i < 4000; ++i) {
    const float scale = i % 2 == 0 ? 2.0f : 0.1f;
    const float x = scale * (2 * random.next_float() - 1), y = scale * random.next_float();
    const float distance = i % 3 == 0 ? 1.0f : 5.0f;
    const uint32_t cell = map.add(on_floor(x, y), distance);
    CHECK(map.find(on_floor(x, y), distance) == cell);
    for (const CellHit& hit : map.hits(cell))
      CHECK(length(hit.position - Vec3{x, y, 0}) <=
            1.4143f * std::max(1 / 64.0f, std::min(1.0f, 2 * length(hit.position))));
  }
  // Far from the lamp cells are as wide as ever; next to it they are as narrow as they can be.
  const auto width = [&](float x) {
    const uint32_t cell = map.find(on_floor(x, 0.01f), 5);
    float end = x;
    while (map.find(on_floor(end, 0.01f), 5) == cell) end += 1e-4f;
    float begin = x;
    while (map.find(on_floor(begin, 0.01f), 5) == cell) begin -= 1e-4f;
    return end - begin;
  };
  CHECK(width(1.5f) == doctest::Approx(1).epsilon(0.01));
  CHECK(width(0.001f) == doctest::Approx(1 / 64.0).epsilon(0.03));
}

TEST_CASE("cells keep more of the hits that the picture needs") {
  Scene s;
  add_quad(s, add_diffuse(s, Rgb{0.5f}), {Vec3{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
  const Tracer tracer(s);
  CellMap map(tracer, 1);
  for (int i = 0; i < 100; ++i) {
    map.add(on_floor(0.1f, 0.001f * float(i)), 5, i % 2 == 1);
    map.add(on_floor(1.1f, 0.001f * float(i)), 5);
  }
  const uint32_t asked = map.find(on_floor(0.1f, 0.1f), 5);
  REQUIRE(map.hits(asked).size() == hits_of_asked_cell);
  CHECK(map.hits(asked)[7].position.y == 0.001f * 7.0f);
  CHECK(map.hits(asked)[8].position.y == 0.001f * 9.0f);  // the next one that was asked for
  CHECK(map.hits(map.find(on_floor(1.1f, 0.1f), 5)).size() == hits_per_cell);
  const CellMap copy = map;
  CHECK(copy.hits(asked).size() == hits_of_asked_cell);
  map.forget_hits();
  CHECK(map.hits(asked).empty());
}

TEST_CASE("a wall divides the cells of the floor that it stands on, wherever it crosses them") {
  const Scene scene = parted_floor();
  const Tracer tracer(scene);
  for (const float size : {0.05f, 0.17f, 0.4f, 1.0f}) {
    CellMap map(tracer, size);
    Random random(3);
    std::vector<int> sides;
    size_t shared = 0, hits = 0;
    for (int i = 0; i < 20000; ++i) {
      const float x = 0.33f + size * (2 * random.next_float() - 1);
      const uint32_t cell = map.add(on_floor(x, 3 * random.next_float() - 1.5f), 5);
      sides.resize(map.size(), 0);
      const int side = x < 0.33f ? 1 : -1;
      if (sides[cell] == 0) sides[cell] = side;
      shared += sides[cell] != side ? 1 : 0;
      ++hits;
    }
    CAPTURE(size);
    CHECK(shared == 0);
    CHECK(map.size() < 60 / size);  // not one cell per hit
  }
}

TEST_CASE("cells of a sphere are few and have similar normals") {
  Scene s;
  s.spheres.push_back({{0, 0, 0}, 1, false, add_diffuse(s, Rgb{0.5f}), no_light});
  const Tracer tracer(s);
  CellMap map(tracer, 0.2f);
  Random random(5);
  for (int i = 0; i < 50000; ++i) {
    const Vec3 n = sphere_from_square(random.next_vec2());
    const uint32_t cell = map.add({n, n, n, 1e-5f}, 5);
    CHECK(dot(n, map.hits(cell)[0].normal) > 0.86f);
  }
  CHECK(map.size() > 200);
  CHECK(map.size() < 2000);
  CHECK(map.bytes() > map.size() * sizeof(CellHit));
}

TEST_CASE("cells of slats are narrow; cells of a floor, even at its edge, are not") {
  constexpr float size = 0.1f;
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  add_quad(s, grey, {Vec3{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
  // Slats of .03 m, 1 m above the floor, one above the other, and shelves as wide as one cell and
  // as three.
  const auto add_shelf = [&](float width, float z) {
    add_quad(s, grey, {Vec3{0, -1, z}, {width, -1, z}, {width, 1, z}, {0, 1, z}});
  };
  for (const float z : {1.0f, 1.03f, 1.06f}) add_shelf(0.03f, z);
  add_shelf(size, 1.5f);
  add_shelf(0.3f, 2);
  const Tracer tracer(s);
  CellMap map(tracer, size);
  map.resolve_narrow(true, 1);
  Random random(3);
  enum class On { floor, slat, shelf };
  std::vector<On> on;
  const auto add = [&](const Vec3& p, On what) {
    CellHit hit = on_floor(p.x, p.y);
    hit.position.z = p.z;
    const uint32_t cell = map.add(hit, 5);
    if (cell == on.size()) on.push_back(what);
    REQUIRE(on[cell] == what);
  };
  for (int i = 0; i < 3000; ++i) {
    const float u = random.next_float(), v = 2 * random.next_float() - 1;
    // Includes the outermost cells of the floor.
    add({2 * v, 2 * (2 * u - 1), 0}, On::floor);
    add({0.03f * u, v, 1 + 0.03f * float(i % 3)}, On::slat);
    // A shelf as wide as one cell is narrow, wherever on it a cell is made.
    add({size * u, v, 1.5f}, On::slat);
    add({0.3f * u, v, 2}, On::shelf);
  }
  REQUIRE(on.size() == map.size());
  size_t slats = 0;
  for (size_t c = 0; c < on.size(); ++c) {
    CHECK(map.is_narrow(c) == (on[c] == On::slat));
    slats += on[c] == On::slat ? 1 : 0;
  }
  CHECK(slats >= 60);
  // Switching it off unmarks existing and further cells.
  map.resolve_narrow(false, 2);
  for (size_t c = 0; c < on.size(); ++c) CHECK_FALSE(map.is_narrow(c));
  map.resolve_narrow(true, 2);
  for (size_t c = 0; c < on.size(); ++c) CHECK(map.is_narrow(c) == (on[c] == On::slat));
  CellMap none(tracer, size);
  CellHit hit = on_floor(0.015f, 0.4f);
  hit.position.z = 1.03f;
  CHECK_FALSE(none.would_be_narrow(hit, 5));
  none.resolve_narrow(true, 1);
  CHECK(none.would_be_narrow(hit, 5));
  hit.position.z = 0;
  CHECK_FALSE(none.would_be_narrow(hit, 5));
}

TEST_CASE("voxels full of leaves do not get one cell per leaf") {
  Scene s;
  add_diffuse(s, Rgb{0.5f});
  const Tracer tracer(s);
  CellMap map(tracer, 1);
  Random random(7);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 n = sphere_from_square(random.next_vec2());
    const Vec3 p{0.5f * random.next_float(), 0.5f * random.next_float(),
                 0.5f * random.next_float()};
    const CellHit leaf{p, n, n, 1e-5f};
    const uint32_t cell = map.add(leaf, 5);
    CHECK(cell != no_cell);
    CHECK(map.find(leaf, 5) == cell);
  }
  CHECK(map.size() < 500);
}
