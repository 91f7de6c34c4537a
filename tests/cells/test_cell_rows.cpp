#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "cells/cell_rows.h"

using namespace troffer;

namespace {

// Cells that see each other at random, and lose some of the light.
CellRows random_rows(size_t cells, float reflectance) {
  CellRows rows;
  Random random(11);
  for (uint32_t i = 0; i < cells; ++i)
    for (const bool half : {false, true}) {
      std::vector<RowEntry> entries(8);
      for (RowEntry& e : entries)
        e = {uint32_t(random.next_float() * float(cells)),
             Rgb{reflectance, reflectance * random.next_float(), 0}};
      rows.add({i, 8, 0, half, Rgb{0}}, entries);
    }
  rows.finish(cells);
  return rows;
}

}  // namespace

TEST_CASE("two cells that see each other reach the exact solution") {
  CellRows rows;
  const std::vector<RowEntry> to_one{{1, Rgb{0.5f}}};
  rows.add({0, 2, 0, false, Rgb{0}}, to_one);
  rows.add({1, 4, 0, false, Rgb{4, 0, 0}}, std::vector<RowEntry>{{0, Rgb{0.8f}}, {0, Rgb{0.8f}}});
  rows.finish(2);
  // E0 = 1 + E1 / 4, E1 = 1 (red) + .4 E0.
  const CellLight light = rows.solve({Rgb{1}, Rgb{0}}, {0, 0}, {1, 1}, 1);
  const double red = (1 + 0.25) / (1 - 0.25 * 0.4), green = 1 / (1 - 0.25 * 0.4);
  CHECK(double(light.irradiance[0].r) == doctest::Approx(red).epsilon(1e-5));
  CHECK(double(light.irradiance[0].g) == doctest::Approx(green).epsilon(1e-5));
  CHECK(double(light.irradiance[1].r) == doctest::Approx(1 + 0.4 * red).epsilon(1e-5));
}

TEST_CASE("a room with reflectance .95 or more keeps its light and is solved in few iterations") {
  for (const float rho : {0.5f, 0.95f, 0.99f}) {
    const CellRows rows = random_rows(2000, rho);
    const std::vector<Rgb> direct(2000, Rgb{1});
    const CellLight light = rows.solve(direct, std::vector<float>(direct.size(), 0),
                                       std::vector<float>(direct.size(), 1), 2);
    CAPTURE(rho);
    for (const Rgb& e : light.irradiance)
      CHECK(double(e.r) == doctest::Approx(1 / (1 - double(rho))).epsilon(2e-4));
    CHECK(light.iterations < 100);
  }
}

// With plain bounces, E - .5 would fall by .001 per bounce, and the difference between the two
// rooms by .003. That is thousands of bounces, which a common factor for all cells does not
// shorten.
TEST_CASE("two bright rooms connected by a narrow gap are solved in few iterations") {
  constexpr uint32_t n = 400;
  constexpr double reflectance = 0.999, chink = 0.001;
  CellRows rows;
  Random random(5);
  for (uint32_t i = 0; i < 2 * n; ++i) {
    const uint32_t room = i / n * n, other = n - room;
    std::vector<RowEntry> entries;
    for (int k = 0; k < 24; ++k)
      entries.push_back({room + std::min(uint32_t(random.next_float() * n), n - 1),
                         Rgb{float(100.0 * reflectance * (1 - chink) / 24)}});
    entries.push_back({other + i % n, Rgb{float(100.0 * reflectance * chink)}});
    rows.add({i, 100, 0, i % 2 == 1, Rgb{0}}, entries);
  }
  rows.finish(2 * n);
  std::vector<Rgb> direct(2 * n, Rgb{0});
  for (uint32_t i = 0; i < n; ++i) direct[i] = Rgb{1};
  const CellLight light =
      rows.solve(direct, std::vector<float>(2 * n, 0), std::vector<float>(2 * n, 1), 2);
  CHECK(light.iterations <= 40);
  // The residual, by the rows again in double precision.
  double worst = 0;
  for (uint32_t i = 0; i < 2 * n; ++i) {
    double sum = 0;
    for (const RowEntry& e : rows.entries(i))
      sum += double(e.weight.g) * double(light.irradiance[e.cell].g);
    const double balance = double(direct[i].g) + sum / 100;
    worst = std::max(worst, std::abs(balance - double(light.irradiance[i].g)) / balance);
  }
  CHECK(worst < 1e-5);
}

TEST_CASE("importance is the adjoint of light") {
  const size_t n = 500;
  Random random(5);
  std::vector<Rgb> direct(n);
  std::vector<float> asked(n);
  for (size_t i = 0; i < n; ++i) {
    direct[i] = Rgb{random.next_float()};
    asked[i] = random.next_float();
  }
  // In grey light the luminances of weights are the weights.
  CellRows grey;
  Random again(11);
  for (uint32_t i = 0; i < n; ++i) {
    std::vector<RowEntry> entries(16);
    for (RowEntry& e : entries)
      e = {uint32_t(again.next_float() * float(n)), Rgb{0.8f * again.next_float()}};
    grey.add({i, 16, 0, i % 2 == 0, Rgb{0}}, entries);
  }
  grey.finish(n);
  const CellLight light = grey.solve(direct, std::vector<float>(n, 0), std::vector<float>(n, 1), 1);
  const std::vector<float> y = grey.importance(asked, {}, 200);
  double forward = 0, backward = 0;
  for (size_t i = 0; i < n; ++i) {
    forward += double(asked[i]) * double(light.irradiance[i].g);
    backward += double(y[i]) * double(direct[i].g);
  }
  CHECK(forward == doctest::Approx(backward).epsilon(1e-3));
  CHECK(std::isfinite(forward));
  // The result does not depend on the start.
  std::vector<float> known(n / 2);
  for (float& k : known) k = 10 * random.next_float();
  const std::vector<float> anew = grey.importance(asked, known, 200);
  for (size_t i = 0; i < n; ++i) CHECK(anew[i] == doctest::Approx(y[i]).epsilon(2e-3));
}

TEST_CASE("the solution is the same for any number of threads") {
  const CellRows rows = random_rows(5000, 0.8f);
  const std::vector<Rgb> direct(5000, Rgb{1, 2, 3});
  const std::vector<float> differences(5000, 0.1f);
  const CellLight one = rows.solve(direct, differences, differences, 1),
                  many = rows.solve(direct, differences, differences, 5);
  CHECK(one.irradiance == many.irradiance);
  CHECK(one.half_difference == many.half_difference);
}

TEST_CASE("the difference of half solutions propagates to the cells that see it") {
  // Both halves of the first cell's rays see the second cell alike.
  CellRows rows;
  const std::vector<RowEntry> entries(4, RowEntry{1, Rgb{0.5f}});
  for (const bool is_second : {false, true}) rows.add({0, 4, 0, is_second, Rgb{0}}, entries);
  rows.finish(2);
  const CellLight light = rows.solve({Rgb{0}, Rgb{2}}, {0, 0.2f}, {1, 1}, 1);
  CHECK(light.irradiance[0].g == doctest::Approx(1));
  CHECK(light.half_difference[1] == doctest::Approx(0.2f));
  CHECK(light.half_difference[0] == doctest::Approx(0.1f));
}

TEST_CASE("noise draws: errors of cells, of their rays and of their hits are independent") {
  constexpr uint32_t cells = 1000;
  CellRows rows;
  // The first cell sees all others, each by one ray; these see nothing.
  std::vector<RowEntry> entries;
  for (uint32_t c = 1; c < cells; ++c) entries.push_back({c, Rgb{0.5f}});
  rows.add({0, cells - 1, 0, false, Rgb{0}}, entries);
  rows.finish(cells);
  std::vector<float> by_rows(cells, 3), by_hits(cells, 4);
  by_rows[0] = by_hits[0] = 0;
  const std::vector<NoiseDraws> draws = rows.noise_draws(by_rows, by_hits, 0, 2);
  REQUIRE(draws.size() == cells);
  double of_others = 0, of_first = 0;
  for (uint32_t c = 1; c < cells; ++c)
    for (const float d : draws[c]) {
      CHECK((std::abs(d) == doctest::Approx(7) || std::abs(d) == doctest::Approx(1)));
      of_others += double(d) * double(d) / (cells - 1) / draws_of_noise;
    }
  CHECK(of_others == doctest::Approx(25).epsilon(0.05));
  for (const float d : draws[0]) of_first += double(d) * double(d) / draws_of_noise;
  // A quarter of the variance of a mean of 999, which sixteen draws estimate within some 35 %.
  CHECK(of_first == doctest::Approx(0.25 * 25 / (cells - 1)).epsilon(0.7));
  // Where cells see each other, errors come back to their cell.
  CellRows both;
  both.add({0, 1, 0, false, Rgb{0}}, std::vector<RowEntry>{{1, Rgb{0.5f}}});
  both.add({1, 1, 0, false, Rgb{0}}, std::vector<RowEntry>{{0, Rgb{0.5f}}});
  both.finish(2);
  const std::vector<NoiseDraws> around = both.noise_draws({1, 0}, {0, 0}, 0, 1);
  for (const float d : around[0])
    CHECK(std::abs(d) == doctest::Approx(1 + 0.25 + 0.0625 + 0.015625).epsilon(1e-3));
}

TEST_CASE("importance stays finite if rows from a file amplify light endlessly") {
  CellRows rows;
  constexpr uint32_t cells = 4;
  for (uint32_t c = 0; c < cells; ++c)
    rows.add({c, 1, 0, false, Rgb{0}},
             std::vector<RowEntry>{{(c + 1) % cells, Rgb{1e30f}}, {(c + 2) % cells, Rgb{1e38f}}});
  rows.finish(cells);
  const std::vector<float> asked(cells, 1);
  const std::vector<float> first = rows.importance(asked, {}, 24);
  for (const std::vector<float>& y : {first, rows.importance(asked, first, 24)})
    for (const float v : y) CHECK(std::isfinite(v));
}

namespace {

// Cells in a crease that see each other by one ray each, which gloss made too heavy, among cells
// that see many.
CellRows rows_with_creases(size_t cells) {
  CellRows rows;
  Random random(3);
  for (uint32_t i = 0; i < cells; ++i) {
    if (i % 10 == 0) {
      rows.add({i, 1, 0, false, Rgb{0}}, std::vector<RowEntry>{{i, Rgb{1.2f}}});
      continue;
    }
    std::vector<RowEntry> entries(16);
    for (RowEntry& e : entries) e = {uint32_t(random.next_float() * float(cells)), Rgb{0.8f}};
    rows.add({i, 16, 0, false, Rgb{0}}, entries);
  }
  rows.finish(cells);
  return rows;
}

// A row of white rooms. In each room, one cell is all that the others see, and it sees those of the
// next room. Summed over cells, the many send back far more than the one gets.
CellRows rows_that_see_few(uint32_t rooms, uint32_t cells_of_room) {
  CellRows rows;
  Random random(7);
  for (uint32_t i = 0; i < rooms * cells_of_room; ++i) {
    const uint32_t room = i / cells_of_room, next = (room + 1) % rooms;
    std::vector<RowEntry> entries(16);
    for (RowEntry& e : entries) {
      const auto any = uint32_t(random.next_float() * float(cells_of_room));
      e = {i % cells_of_room == 0 ? next * cells_of_room + any : room * cells_of_room, Rgb{0.93f}};
    }
    rows.add({i, 16, 0, false, Rgb{0}}, entries);
  }
  rows.finish(rooms * cells_of_room);
  return rows;
}

}  // namespace

TEST_CASE("random rays that would let cells amplify their own light do not") {
  const size_t n = 1000;
  const CellRows rows = rows_with_creases(n);
  const std::vector<float> y = rows.importance(std::vector<float>(n, 1), {}, 100000);
  const double most = double(*std::max_element(y.begin(), y.end()));
  CHECK(most < 1e5);
  const CellLight light = rows.solve(std::vector<Rgb>(n, Rgb{1}), std::vector<float>(n, 0), y, 1);
  CHECK(light.iterations < 200);
  for (const Rgb& e : light.irradiance) {
    CHECK(e.g > 0.99f);
    CHECK(e.g < 101);  // 1 / (1 - .99)
  }
}

TEST_CASE(
    "rows with a few cells that nearly all others see are still solved with an energy balance") {
  const uint32_t rooms = 40, cells_of_room = 100;
  const size_t n = size_t(rooms) * cells_of_room;
  const CellRows rows = rows_that_see_few(rooms, cells_of_room);
  const std::vector<float> asked(n, 1);
  std::vector<Rgb> direct(n, Rgb{0});
  for (size_t i = 0; i < cells_of_room; ++i) direct[i] = Rgb{1};
  const CellLight light =
      rows.solve(direct, std::vector<float>(n, 0), rows.importance(asked, {}, 2000), 2);
  CHECK(light.iterations < 250);
  double worst = 0, all = 0;
  for (uint32_t i = 0; i < n; ++i) {
    double sum = double(direct[i].g);
    for (const RowEntry& e : rows.entries(i))
      sum += double(e.weight.g) / 16 * double(light.irradiance[e.cell].g);
    worst += std::abs(sum - double(light.irradiance[i].g));
    all += double(light.irradiance[i].g);
  }
  CHECK(worst < 1e-4 * all);
}
