// Files of cells: what comes back, what is refused, and how cells are added to them.
#include "cells/cell_store.h"

#include <doctest/doctest.h>

#include <cstring>

#include "base/error.h"
#include "base/random.h"
#include "support/scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace test_cell_store {

namespace {

constexpr uint64_t key = 77;

CellHit on_floor(float x, float y) {
  return {{x, y, 0}, {0, 0, 1}, {0, 0, 1}, 1e-5f};
}

Scene floor_scene() {
  Scene s;
  add_quad(s, add_diffuse(s, Rgb{0.5f}), {Vec3{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}});
  return s;
}

// Makes cells from this many hits on the floor; they see each other at random.
CellStore random_store(const Tracer& tracer, int hits) {
  CellStore store;
  auto map = std::make_shared<CellMap>(tracer, 0.5f);
  map->halve_where([](const CellOutline& cell, bool) { return cell.corners[0].x < -3.5f; });
  Random random(3);
  for (int i = 0; i < hits; ++i)
    map->add(on_floor(8 * random.next_float() - 4, 8 * random.next_float() - 4), i % 3 == 0 ? 0.5f
                                                                                 : i % 3 == 1
                                                                                     ? 5.0f
                                                                                     : 40.0f);
  std::vector<uint32_t> cells;
  for (uint32_t c = 0; c < map->size(); ++c)
    if (!map->hits(c).empty()) cells.push_back(c);
  CHECK(cells.size() < map->size());  // the other cells are halved
  for (uint32_t c = 0; c < map->size(); ++c) {
    std::vector<RowEntry> entries(c % 5);
    for (RowEntry& e : entries)
      e = {cells[random.next_u32() % cells.size()],
           {random.next_float(), random.next_float(), 0.5f}};
    if (!map->hits(c).empty()) store.rows.add({c, 8, 0, c % 2 == 1, Rgb{float(c % 7)}}, entries);
    store.direct.emplace_back(random.next_float());
    store.direct_half_difference.push_back(random.next_float() - 0.5f);
  }
  store.rows.finish(map->size());
  store.map = std::move(map);
  store.direct_error = 0.1;
  return store;
}

std::string refusal(const std::vector<uint8_t>& bytes, uint64_t scene, const Tracer& tracer) {
  try {
    load_cells(bytes, "a.cells", scene, tracer);
  } catch (const InputError& e) {
    CHECK(e.file() == "a.cells");
    return e.reason();
  }
  return "";
}

}  // namespace

TEST_CASE("stored cells are restored exactly: same bytes, and every hit finds its cell") {
  const Scene scene = floor_scene();
  const Tracer tracer(scene);
  const CellStore store = random_store(tracer, 3000);
  const std::vector<uint8_t> bytes = save_cells(store, key);
  REQUIRE(are_cells(bytes));
  const CellStore back = load_cells(bytes, "a.cells", key, tracer);
  CHECK(save_cells(back, key) == bytes);
  REQUIRE(back.map->size() == store.map->size());
  Random random(8);
  int found = 0;
  for (int i = 0; i < 5000; ++i) {
    const CellHit hit = on_floor(9 * random.next_float() - 4.5f, 9 * random.next_float() - 4.5f);
    for (const float distance : {0.5f, 5.0f, 40.0f}) {
      const uint32_t cell = store.map->find(hit, distance);
      CHECK(back.map->find(hit, distance) == cell);
      found += cell != no_cell ? 1 : 0;
    }
  }
  CHECK(found > 5000);
  const std::vector<float> even(store.direct.size(), 1);
  const CellLight a = store.rows.solve(store.direct, store.direct_half_difference, even, 1);
  const CellLight b = back.rows.solve(back.direct, back.direct_half_difference, even, 1);
  CHECK(a.irradiance == b.irradiance);
}

TEST_CASE("stored cells get no more hits, new cells beside them do") {
  const Scene scene = floor_scene();
  const Tracer tracer(scene);
  CellMap map(tracer, 1);
  const uint32_t old = map.add(on_floor(0.1f, 0.1f), 5);
  map.freeze();
  CHECK(map.add(on_floor(0.2f, 0.1f), 5) == old);
  CHECK(map.hits(old).size() == 1);
  const uint32_t young = map.add(on_floor(3.1f, 0.1f), 5);
  CHECK(map.add(on_floor(3.2f, 0.1f), 5) == young);
  CHECK(map.hits(young).size() == 2);
}

TEST_CASE("a stored cell keeps all hits of a picture's own rays, not only the first eight") {
  const Scene scene = floor_scene();
  const Tracer tracer(scene);
  auto map = std::make_shared<CellMap>(tracer, 1.0f);
  Random random(5);
  CellStore store;
  // Cells with 1, 8, 9, 20, and more hits than a cell keeps.
  const std::vector<std::pair<int, size_t>> cells{{1, 1}, {8, 8}, {9, 9}, {20, 20}, {50, 32}};
  for (size_t c = 0; c < cells.size(); ++c)
    for (int i = 0; i < cells[c].first; ++i)
      REQUIRE(map->add(on_floor(float(c) + 0.2f * random.next_float(), 0.2f * random.next_float()),
                       5, true) == c);
  store.direct.resize(map->size());
  store.direct_half_difference.resize(map->size());
  store.rows.finish(map->size());
  store.map = map;
  const CellStore back = load_cells(save_cells(store, key), "a.cells", key, tracer);
  REQUIRE(back.map->size() == cells.size());
  for (size_t c = 0; c < cells.size(); ++c) {
    CAPTURE(c);
    const auto before = map->hits(c), after = back.map->hits(c);
    REQUIRE(before.size() == cells[c].second);
    REQUIRE(after.size() == before.size());
    for (size_t i = 0; i < before.size(); ++i) CHECK(after[i].position == before[i].position);
  }
}

TEST_CASE("damaged files of cells, and those of other scenes, are refused") {
  const Scene scene = floor_scene();
  const Tracer tracer(scene);
  const std::vector<uint8_t> bytes = save_cells(random_store(tracer, 300), key);
  CHECK(refusal(bytes, key, tracer).empty());
  CHECK(refusal(bytes, key + 1, tracer).find("another scene") != std::string::npos);
  for (const size_t n : {size_t(0), size_t(5), size_t(8), size_t(79), size_t(80), bytes.size() / 2,
                         bytes.size() - 1}) {
    const std::vector<uint8_t> part(bytes.begin(), bytes.begin() + std::ptrdiff_t(n));
    CHECK_FALSE(refusal(part, key, tracer).empty());
  }
  std::vector<uint8_t> longer = bytes;
  longer.push_back(0);
  CHECK_FALSE(refusal(longer, key, tracer).empty());
  Random r(1);
  for (size_t i = 0; i < 500; ++i) {  // every byte of the header, and some of the rest
    std::vector<uint8_t> bad = bytes;
    const size_t at = i < 80 ? i : r.next_u32() % bytes.size();
    bad[at] = uint8_t(bad[at] ^ (1u << (r.next_u32() % 8)));
    CHECK_FALSE(refusal(bad, key, tracer).empty());
  }
}

TEST_CASE("impossible values are refused even if the file is complete") {
  const Scene scene = floor_scene();
  const Tracer tracer(scene);
  const float nan = std::nanf("");
  const auto with = [&](const auto& change) {
    CellStore s = random_store(tracer, 300);
    change(s);
    return refusal(save_cells(s, key), key, tracer);
  };
  CHECK(with([](CellStore&) {}).empty());
  CHECK_FALSE(with([&](CellStore& s) { s.direct[7] = Rgb{nan}; }).empty());
  CHECK_FALSE(with([&](CellStore& s) { s.direct_half_difference[7] = nan; }).empty());
  CHECK_FALSE(with([&](CellStore& s) { s.direct_error = double(nan); }).empty());
  CHECK_FALSE(with([](CellStore& s) {
                s.rows.add({0, 8, 0, false, Rgb{0}},
                           std::vector<RowEntry>{{uint32_t(s.map->size()), Rgb{1}}});
              }).empty());
  CHECK_FALSE(with([](CellStore& s) {
                s.rows.add({uint32_t(s.map->size()), 8, 0, false, Rgb{0}}, {});
              }).empty());
  CHECK_FALSE(with([](CellStore& s) {
                s.rows.add({0, 8, 0, false, Rgb{0}}, std::vector<RowEntry>{{0, Rgb{-1}}});
              }).empty());
  // A halved cell has no row, and no cell sees it.
  const auto halved = [](const CellStore& s) {
    uint32_t c = 0;
    while (!s.map->hits(c).empty()) ++c;
    return c;
  };
  CHECK_FALSE(with([&](CellStore& s) {
                s.rows.add({halved(s), 8, 0, false, Rgb{0}}, {});
              }).empty());
  CHECK_FALSE(with([&](CellStore& s) {
                s.rows.add({0, 8, 0, false, Rgb{0}}, std::vector<RowEntry>{{halved(s), Rgb{1}}});
              }).empty());
  CHECK_FALSE(with([](CellStore& s) { s.rows.add({0, 0, 0, false, Rgb{0}}, {}); }).empty());
  // Voxels of such a size cannot be numbered.
  CHECK_FALSE(with([&](CellStore& s) {
                s = {};
                auto map = std::make_shared<CellMap>(tracer, 1e-7f);
                map->add(on_floor(0.1f, 0.1f), 5);
                s.map = std::move(map);
                s.direct.assign(1, Rgb{1});
                s.direct_half_difference.assign(1, 0);
                s.rows.finish(1);
              }).empty());
}

}  // namespace test_cell_store
