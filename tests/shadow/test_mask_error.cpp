// Compares the estimated error of masks with the actual one.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <string>

#include "base/units.h"
#include "clutter.h"
#include "one_source.h"
#include "shadow/mask_cell.h"

using namespace troffer;
using namespace troffer::test;

namespace {

struct Errors {
  double made = 0, told = 0;  // root mean squares of the share
};

// Measures the errors for a receiver with this normal, over scenes and shifts of the lattice.
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
    FacetList list = one.list_of(frame, make(random));
    list.find_edges_along(lattice);
    MaskMemory memory;
    double mean = 0, squares = 0;
    for (uint64_t pass = 0; pass < passes; ++pass) {
      const MaskShare seen =
          mask_share_of({task, frame, one.unoccluded, 1, true, false}, 0, list, pass, memory);
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

// A receiver that sees the source at a grazing angle gets only a sliver of it, with few samples.
TEST_CASE("masks: the estimated error is the actual error, behind random occluders") {
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

// Along a side of the source all samples have different positions, so parallel edges err far less
// than others.
TEST_CASE("masks: the estimated error is the actual error, behind blinds") {
  const auto check = [](const MaskLattice& lattice, const Vec3& normal) {
    const auto is_told = [&](const char* name, const auto& make, double most = 2) {
      const Errors e = errors_of(lattice, normal, make);
      CAPTURE(std::string(name));
      CAPTURE(normal.z);
      CAPTURE(lattice.rows);
      CHECK(e.made > 0.0002);
      CHECK(e.told > 0.85 * e.made);
      CHECK(e.told < most * e.made);
    };
    const auto blinds = [](int n, float open, float angle) {
      return [=](Random& r) {
        // the distance of the slats, projected to the source, is about 1 / n of it
        const float step = (1.0f + 0.3f * r.next_float()) * 0.6f / float(n);
        return slats(r, 3 * n, step, step * (1 - open), angle);
      };
    };
    for (const float turn : {0.0f, float(0.5 * pi)}) {
      CAPTURE(turn);
      is_told("1 slat", blinds(1, 0.5f, turn));
      is_told("5 slats", blinds(5, 0.5f, turn));
      is_told("20 slats", blinds(20, 0.6f, turn));
      is_told("60 slats", blinds(60, 0.5f, turn));
      is_told("90 slats", blinds(90, 0.4f, turn));
      is_told("90 slats, little open", blinds(90, 0.15f, turn));
      is_told("400 slats", blinds(400, 0.5f, turn), 5);
    }
    const auto bars = [](int n, float width) {  // anywhere, of any width
      return [=](Random& r) {
        std::vector<Quad> out;
        for (int i = 0; i < n; ++i) {
          const Vec3 at = before_source(r, 0.8f, 1.6f) * 1.2f;
          out.push_back(parallelogram_facet(at - Vec3{0, 3, 0}, {2 * width * r.next_float(), 0, 0},
                                            {0, 6, 0}));
        }
        return out;
      };
    };
    is_told("3 bars", bars(3, 0.05f));
    is_told("20 bars", bars(20, 0.015f));
    is_told("100 bars", bars(100, 0.004f));
    is_told("400 bars", bars(400, 0.001f));
    // Edges that are parallel, but not to a side, err less than estimated, never more. Half a
    // degree off, an edge passes through every fourth sample of each row.
    is_told("60 turned slats", blinds(60, 0.5f, 0.0094f), 4);
    is_told("5 turned slats", blinds(5, 0.5f, 0.0094f), 4);
    is_told("60 slats at 30 degrees", blinds(60, 0.5f, 0.52f), 5);
  };
  check(fine_lattice, {0, 0, 1});
  check(coarse_lattice, {0, 0, 1});
  check(fine_lattice, {1, 0.3f, 0.05f});
}
