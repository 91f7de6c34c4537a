// Places on cells are a fair choice among all hits, whatever their order.
#include <doctest/doctest.h>

#include <cmath>

#include "annual/transport_cells.h"

using namespace troffer;

TEST_CASE("every hit of a cell is as likely to stay as any other") {
  constexpr size_t hits = 40, draws = 4000;
  std::array<double, hits> kept{};
  for (uint64_t seed = 0; seed < draws; ++seed) {
    CellPlaces places(seed);
    for (size_t i = 0; i < hits; ++i) {
      CellHit hit;
      hit.position.x = float(i);
      places.add(3, hit);
    }
    CHECK(places.size() == 4);
    CHECK(places.of(2).empty());
    REQUIRE(places.of(3).size() == hits_per_cell);
    for (const CellHit& h : places.of(3)) kept[size_t(h.position.x)] += 1;
  }
  // Each stays with probability p = 8/40, so its count has a variance of draws × p (1 − p).
  const double p = double(hits_per_cell) / double(hits), expected = p * double(draws);
  for (const double k : kept) CHECK(std::abs(k - expected) < 4.5 * std::sqrt(expected * (1 - p)));
}

TEST_CASE("few hits all stay, in their order") {
  CellPlaces places(1);
  for (size_t i = 0; i < 5; ++i) {
    CellHit hit;
    hit.position.x = float(i);
    places.add(0, hit);
  }
  REQUIRE(places.of(0).size() == 5);
  for (size_t i = 0; i < 5; ++i) CHECK(places.of(0)[i].position.x == float(i));
}
