// What masks tell of their error, beside what they make.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <string>

#include "clutter.h"
#include "one_source.h"
#include "shadow/mask_cell.h"

using namespace troffer;
using namespace troffer::test;

namespace {

struct Errors {
  double made = 0, told = 0;  // root mean squares, of the share
};

// Of a receiver with such a normal, over scenes and shifts of the lattice.
Errors errors_of(const MaskLattice& lattice, const Vec3& normal,
                 const std::function<std::vector<Quad>(Random&)>& make) {
  constexpr int scenes = 40, passes = 100;
  double made = 0, told = 0;
  Random random(7);
  for (int s = 0; s < scenes; ++s) {
    std::vector<ShadowReceiver> r = receivers_on_floor(1, 0.1f);
    r[0].normal = r[0].horizon = normalize(normal);
    r[0].stream = hash_of(uint64_t(s), 5u);
    OneSource one(r);
    one.options.lattice = lattice;
    const SourceTask task = one.task();
    const MaskFrame frame = one.frame();
    const FacetList list = one.list_of(frame, make(random));
    MaskMemory memory;
    double mean = 0, squares = 0;
    for (uint64_t pass = 0; pass < passes; ++pass) {
      const MaskShare seen =
          look_at_cell({task, frame, one.unoccluded, 1, true, false}, 0, list, pass, memory);
      const double share = seen.share < 0 ? 0.5 : double(seen.share);
      mean += share / passes;
      squares += share * share / passes;
      told += (seen.share < 0 ? 0.25 : double(seen.variance)) / (passes * scenes);
    }
    made += std::max(squares - mean * mean, 0.0) / scenes;
  }
  return {std::sqrt(made), std::sqrt(told)};
}

}  // namespace

// A receiver that the source's plane rises over steeply sees a sliver of it, with a few samples.
TEST_CASE("masks: the error that is told is the error that is made, behind whatever") {
  const auto check = [](const MaskLattice& lattice, const Vec3& normal, double least) {
    const auto is_told = [&](const char* name, const auto& make) {
      const Errors e = errors_of(lattice, normal, make);
      CAPTURE(std::string(name));
      CAPTURE(normal.z);
      CAPTURE(lattice.rows);
      CHECK(e.made > 0.0005);
      CHECK(e.told > least * e.made);
      CHECK(e.told < 1.8 * e.made);
    };
    is_told("edge", [](Random& r) { return std::vector<Quad>{half_plane(r)}; });
    is_told("3 wires", [](Random& r) { return wires(r, 3, 0.05f); });
    is_told("20 wires", [](Random& r) { return wires(r, 20, 0.0075f); });
    is_told("400 wires", [](Random& r) { return wires(r, 400, 0.000375f); });
    is_told("10 leaves", [](Random& r) { return leaves(r, 10, 0.1f); });
    is_told("400 leaves", [](Random& r) { return leaves(r, 400, 0.04f); });
    is_told("1500 leaves", [](Random& r) { return leaves(r, 1500, 0.04f); });
    is_told("2000 small leaves", [](Random& r) { return leaves(r, 2000, 0.01f); });
  };
  check(fine_lattice, {0, 0, 1}, 0.85);
  check(coarse_lattice, {0, 0, 1}, 0.85);
  check(fine_lattice, {1, 0.3f, 0.05f}, 0.8);
  check(fine_lattice, {1, 0.3f, -0.21f}, 0.75);
}
