// LightTree with lights at infinity.
#include <doctest/doctest.h>

#include <cmath>

#include "light/light.h"
#include "select/light_tree.h"
#include "support/chi_square.h"
#include "support/light_scenes.h"
#include "support/surfaceless_lights.h"

using namespace troffer;
using namespace troffer::test;

namespace test_lights_at_infinity {

namespace {

// Distant lights from above and from below, an environment light, and lights with a place.
Scene mixed_lights(uint64_t seed, int placed) {
  Scene s = placed > 0 ? random_lights(seed, placed) : Scene{};
  add_distant(s, {0.2f, 0.1f, -1}, Rgb{3});
  if (placed > 0) add_point(s, {0.1f, 0.2f, 5}, Rgb{100});
  add_environment(s, Rgb{1});
  add_distant(s, {0.5f, 0.3f, 1}, Rgb{2});
  if (placed > 0) add_spot(s, {1, 0, 4}, {0, 0, -1}, 0.9f, 0.8f, Rgb{50});
  return s;
}

double sum_of_pmf(const LightTree& tree, const LightPrimitives& lights, const Receiver& at,
                  bool both_sides) {
  double sum = 0;
  for (uint32_t p = 0; p < lights.size(); ++p)
    sum += double(tree.pmf(at.position, at.normal, both_sides, p));
  return sum;
}

}  // namespace

TEST_CASE("with lights at infinity probabilities add up to one, and choose() follows pmf()") {
  for (const int placed : {0, 5, 40}) {
    const Scene scene = mixed_lights(uint64_t(placed), placed);
    const LightPrimitives lights(scene);
    const LightTree tree(lights);
    CHECK_FALSE(tree.is_empty());
    Scene placed_scene = scene;
    std::erase_if(placed_scene.lights, [](const Light& e) {
      return e.kind == LightKind::distant || e.kind == LightKind::environment;
    });
    const LightPrimitives placed_lights(placed_scene);
    const LightTree placed_tree(placed_lights);
    Random r(uint64_t(placed) + 1);
    int chosen = 0;
    for (int i = 0; i < 300; ++i) {
      Receiver at;
      at.position = random_point(r, 3);
      at.normal = random_direction(r);
      const bool both_sides = i % 2 == 0;
      const double sum = sum_of_pmf(tree, lights, at, both_sides);
      double beside = 0;
      for (const uint32_t p : lights.at_infinity())
        beside += tree.pmf(at.position, at.normal, both_sides, p) > 0;
      // The tree's own sum is below one if choose() meets two dark children below a lit parent.
      const double in_tree = sum_of_pmf(placed_tree, placed_lights, at, both_sides);
      CHECK(sum < 1 + 1e-5);
      CHECK(beside >= (both_sides ? 3 : 1));
      if (in_tree > 0)
        CHECK(sum == doctest::Approx((beside + in_tree) / (beside + 1)).epsilon(1e-5));
      else if (placed == 0)
        CHECK(sum == doctest::Approx(1).epsilon(1e-6));
      const LightChoice c = tree.choose(at.position, at.normal, both_sides, r.next_float());
      if (c.pmf == 0) continue;
      ++chosen;
      CHECK(
          c.pmf ==
          doctest::Approx(tree.pmf(at.position, at.normal, both_sides, c.primitive)).epsilon(1e-5));
      CHECK(c.u >= 0);
      CHECK(c.u < 1);
    }
    CHECK(chosen > (placed == 0 ? 299 : 200));
  }
}

TEST_CASE("lights at infinity are chosen with their probabilities, for many points as for one") {
  const Scene scene = mixed_lights(7, 12);
  const LightPrimitives lights(scene);
  const LightTree tree(lights);
  constexpr size_t draws = 60000;
  Random r(9);
  for (const Vec3& normal : {Vec3{0, 0, 1}, Vec3{0, 0, -1}, normalize(Vec3{1, 0, 0.1f})}) {
    LightReceivers receivers;
    receivers.resize(draws);
    std::vector<double> observed(lights.size() + 1), expected(lights.size() + 1);
    for (size_t i = 0; i < draws; ++i)
      receivers.set(i, {0.2f, 0.1f, 0}, normal, false, r.next_float());
    std::vector<LightChoice> choices(draws);
    std::vector<float> scratch;
    tree.choose_many(receivers, choices.data(), scratch);
    for (size_t i = 0; i < draws; ++i) {
      const LightChoice one = tree.choose({0.2f, 0.1f, 0}, normal, false, receivers.u[i]);
      REQUIRE(one.pmf == choices[i].pmf);
      REQUIRE(one.primitive == choices[i].primitive);
      REQUIRE(one.u == choices[i].u);
      ++observed[one.pmf > 0 ? one.primitive : lights.size()];
    }
    double sum = 0;
    for (uint32_t p = 0; p < lights.size(); ++p)
      sum += expected[p] = draws * double(tree.pmf({0.2f, 0.1f, 0}, normal, false, p));
    expected.back() = std::max(0.0, double(draws) - sum);
    if (expected.back() < 1e-3 * draws) expected.back() = 0;
    const auto test = chi_square_test(observed, expected, 1, sidak(1e-4, 3));
    CHECK_MESSAGE(test.is_accepted, test.text());
  }
}

TEST_CASE("the tree never leaves out a point, spot or distant light that shines on a receiver") {
  Random r(21);
  for (int i = 0; i < 500; ++i) {
    Scene scene = random_lights(uint64_t(i), 3);
    const Vec3 position = random_point(r, 4), direction = random_direction(r);
    const float cos_outer = 2 * r.next_float() - 1;
    add_point(scene, random_point(r, 4), Rgb{1});
    add_spot(scene, position, direction, std::max(cos_outer, 0.9f), cos_outer, Rgb{1});
    add_distant(scene, random_direction(r), Rgb{1});
    const LightPrimitives lights(scene);
    const LightTree tree(lights);
    for (int k = 0; k < 20; ++k) {
      const Vec3 x = random_point(r, 4), n = random_direction(r);
      for (uint32_t p = uint32_t(lights.size()) - 3; p < lights.size(); ++p) {
        LightSample s;
        if (!sample(scene, lights[p], x, {}, s) || !(dot(s.wi, n) > 1e-3f)) continue;
        if (!(luminance(s.radiance) * s.distance * s.distance > 1e-3f)) continue;
        CHECK(tree.pmf(x, n, false, p) > 0);
      }
    }
  }
}

}  // namespace test_lights_at_infinity
