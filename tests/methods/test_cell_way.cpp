// Choice between gathers, paths that end at cells, and plain paths.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/random.h"
#include "methods/cell_way.h"

using namespace troffer;

namespace test_cell_way {

TEST_CASE("where only gathers are possible they are chosen") {
  CHECK(cheapest_way({}, {}, 1e12) == CellWay::gathers);
}

TEST_CASE("of clearly different costs the least wins") {
  CHECK(cheapest_way(10, 100, 100) == CellWay::paths);
  CHECK(cheapest_way(100, 10, 100) == CellWay::cached_paths);
  CHECK(cheapest_way(100, 100, 10) == CellWay::gathers);
  CHECK(cheapest_way({}, 10, 100) == CellWay::cached_paths);
  CHECK(cheapest_way(10, {}, 100) == CellWay::paths);
}

TEST_CASE("of equal costs the best known one wins: paths, then gathers") {
  CHECK(cheapest_way(10, 10, 10) == CellWay::paths);
  CHECK(cheapest_way({}, 10, 10) == CellWay::gathers);
  CHECK(cheapest_way(10, {}, 10) == CellWay::paths);
}

TEST_CASE("no choice costs more than 1.6 times the least, whatever is possible") {
  Random r(1);
  const auto cost = [&] { return std::exp(4.0 * double(r.next_float())); };
  for (int i = 0; i < 10'000; ++i) {
    const double gathers = cost(), p = cost(), c = cost();
    const std::optional<double> paths = r.next_float() < 0.7f ? std::optional(p) : std::nullopt;
    const std::optional<double> cached = r.next_float() < 0.7f ? std::optional(c) : std::nullopt;
    double least = gathers;
    if (paths) least = std::min(least, *paths);
    if (cached) least = std::min(least, *cached);
    double chosen = gathers;
    switch (cheapest_way(paths, cached, gathers)) {
      case CellWay::paths:
        REQUIRE(paths.has_value());
        chosen = *paths;
        break;
      case CellWay::cached_paths:
        REQUIRE(cached.has_value());
        chosen = *cached;
        break;
      case CellWay::gathers:
        break;
    }
    CHECK(chosen < 1.6 * least);  // 1.25²: two comparisons, each with that uncertainty
  }
}

}  // namespace test_cell_way
