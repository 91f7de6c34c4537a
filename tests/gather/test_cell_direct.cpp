// Direct light of cells.
#include "gather/cell_direct.h"

#include <doctest/doctest.h>

#include "support/light_scenes.h"
#include "support/scenes.h"
#include "transport/light_tree_direct.h"
#include "transport/prepared_scene.h"

using namespace troffer;
using namespace troffer::test;

namespace {

const StopFlag never = false;

Scene lit_floor() {
  Scene s;
  add_quad(s, add_diffuse(s, Rgb{0.5f}), {Vec3{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
  add_ceiling_light(s, 1, 2, Rgb{3});
  return s;
}

}  // namespace

TEST_CASE("light samples of cells follow the seed and do not depend on the number of threads") {
  const PreparedScene scene(lit_floor());
  const GatherWalks walks(scene, nullptr);
  CellMap map(scene.tracer, 0.2f);
  for (int i = 0; i < 40; ++i)
    map.add({{-1.8f + 0.09f * float(i), 0.3f, 0}, {0, 0, 1}, {0, 0, 1}, 1e-4f}, 1, true);
  const LightTreeDirect direct(scene);
  const std::vector<uint16_t> samples(map.size(), 2);
  const auto lit = [&](uint64_t seed, int threads) {
    CellDirectLight light;
    Counters counters;
    add_direct_light(map, {walks, direct, never, seed, threads, nullptr}, samples, 0, light,
                     counters);
    return light.irradiance;
  };
  const std::vector<Rgb> first = lit(0, 1), other = lit(1, 1);
  CHECK(first == lit(0, 3));
  size_t equal = 0;
  Rgb sum{0}, sum_of_other{0};
  for (size_t c = 0; c < first.size(); ++c) {
    equal += first[c] == other[c] ? 1 : 0;
    sum += first[c];
    sum_of_other += other[c];
  }
  REQUIRE(first.size() > 10);
  CHECK(equal == 0);
  CHECK(luminance(sum) == doctest::Approx(luminance(sum_of_other)).epsilon(0.2));
}
