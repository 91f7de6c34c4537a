// LightTree: probabilities sum to one, match the frequencies of choose(), and are positive for
// every light that shines.
#include "base/warp.h"
#include "select/light_tree.h"
#include "support/scenes.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "light/irradiance.h"
#include "support/chi_square.h"
#include "support/light_scenes.h"
#include "support/stopwatch.h"

using namespace troffer;
using namespace troffer::test;

namespace {

double sum_of_pmf(const LightTree& tree, const LightPrimitives& lights, const Receiver& at,
                  bool both_sides) {
  double sum = 0;
  for (uint32_t p = 0; p < lights.size(); ++p)
    sum += double(tree.pmf(at.position, at.normal, both_sides, p));
  return sum;
}

// choose() and pmf() walk the tree in opposite directions and round differently.
bool is_same(float a, float b) {
  return std::abs(a - b) <= 3e-6f * std::max(a, b);
}

// Irradiance; from both sides if both_sides.
double exact(const LightPrimitive& p, const Receiver& at, bool both_sides) {
  const Vec3d x(at.position), n(at.normal);
  return irradiance(p, x, n) + (both_sides ? irradiance(p, x, -n) : 0);
}

}  // namespace

TEST_CASE("probabilities add up to one or, if no source can shine, to zero") {
  int all_ones = 0;
  for (uint64_t seed = 0; seed < 60; ++seed) {
    const Scene scene = random_lights(seed, 1 + int(seed * 7 % 50));
    const LightPrimitives lights(scene);
    const LightTree tree(lights);
    Random r(seed + 1000);
    int ones = 0;
    for (int i = 0; i < 60; ++i) {
      const Receiver at = random_receiver(lights, r);
      const bool both_sides = r.next_u32() % 2 == 0;
      const double sum = sum_of_pmf(tree, lights, at, both_sides);
      const LightChoice c = tree.choose(at.position, at.normal, both_sides, r.next_float());
      CAPTURE(seed);
      CAPTURE(i);
      // choose() gives up if it meets two dark children below a lit parent. So sums between 0 and 1
      // are allowed, but never above 1.
      CHECK(sum < 1 + 1e-4);
      CHECK(sum >= double(c.pmf) * (1 - 1e-5));
      ones += std::abs(sum - 1) < 1e-4;
    }
    all_ones += ones;
  }
  CHECK(all_ones > 60 * 60 / 2);
}

TEST_CASE("choose and pmf agree on the primitive chosen") {
  for (uint64_t seed = 0; seed < 50; ++seed) {
    const Scene scene = random_lights(seed, 40);
    const LightPrimitives lights(scene);
    const LightTree tree(lights);
    Random r(seed + 2000);
    for (int i = 0; i < 200; ++i) {
      const Receiver at = random_receiver(lights, r);
      const LightChoice c = tree.choose(at.position, at.normal, false, r.next_float());
      if (c.pmf == 0) continue;
      CHECK(is_same(c.pmf, tree.pmf(at.position, at.normal, false, c.primitive)));
      CHECK(c.u >= 0);
      CHECK(c.u < 1);
    }
  }
}

TEST_CASE("choose() has the frequencies of pmf() and leaves a uniform number") {
  constexpr int scenes = 24, draws = 40000, bins = 32;
  const double significance = sidak(1e-4, 2 * scenes);
  for (uint64_t seed = 0; seed < scenes; ++seed) {
    const Scene scene = random_lights(seed + 50, 2 + int(seed));
    const LightPrimitives lights(scene);
    const LightTree tree(lights);
    Random r(seed + 3000);
    const bool both_sides = seed % 2 == 1;
    Receiver at;
    do at = random_receiver(lights, r);
    while (sum_of_pmf(tree, lights, at, both_sides) < 0.5);
    // The last bin counts choices of no primitive.
    std::vector<double> observed(lights.size() + 1), expected(lights.size() + 1), rest(bins);
    double chosen = 0;
    for (uint32_t p = 0; p < lights.size(); ++p)
      expected[p] = draws * double(tree.pmf(at.position, at.normal, both_sides, p));
    double sum = 0;
    for (const double e : expected) sum += e;
    expected.back() = std::max(0.0, draws - sum);
    if (expected.back() < 1e-3 * draws) expected.back() = 0;
    for (int i = 0; i < draws; ++i) {
      const LightChoice c = tree.choose(at.position, at.normal, both_sides, r.next_float());
      ++observed[c.pmf > 0 ? c.primitive : lights.size()];
      if (!(c.pmf > 0.01f)) continue;  // after rare choices u has few random bits left
      ++rest[size_t(c.u * bins)];
      ++chosen;
    }
    CAPTURE(seed);
    const auto choice = chi_square_test(observed, expected, 1, significance);
    CHECK_MESSAGE(choice.is_accepted, choice.text());
    const auto remainder =
        chi_square_test(rest, std::vector<double>(bins, chosen / bins), 1, significance);
    CHECK_MESSAGE(remainder.is_accepted, remainder.text());
  }
}

TEST_CASE("no source that shines on a point has probability zero") {
  size_t lit = 0;
  double least = 1;
  for (uint64_t seed = 0; seed < 300; ++seed) {
    const Scene scene = random_lights(seed + 100, 1 + int(seed % 30));
    const LightPrimitives lights(scene);
    const LightTree tree(lights);
    Random r(seed + 4000);
    for (int i = 0; i < 60; ++i) {
      const Receiver at = random_receiver(lights, r);
      const bool both_sides = i % 3 == 0;
      for (uint32_t p = 0; p < lights.size(); ++p) {
        // Below 1e-10 sr, the receiver's rounding to single precision decides.
        if (!(exact(lights[p], at, both_sides) > 1e-10)) continue;
        ++lit;
        const float pmf = tree.pmf(at.position, at.normal, both_sides, p);
        least = std::min(least, double(pmf));
        CAPTURE(seed);
        CAPTURE(i);
        CAPTURE(p);
        CAPTURE(int(lights[p].shape));
        CHECK(pmf > 0);
      }
    }
  }
  MESSAGE("pairs of lit points and sources: ", lit, ", least probability ", least);
  CHECK(lit > 50000);
}

TEST_CASE("a primitive beside one 1e12 times as strong keeps its probability") {
  Scene s;
  const uint32_t m = add_diffuse(s, Rgb{0});
  for (const float x : {-3.0f, 3.0f}) {
    const Vec3 c{x, 0, 2};
    make_light(
        s,
        add_quad(s, m,
                 {c + Vec3{-1, -1, 0}, c + Vec3{-1, 1, 0}, c + Vec3{1, 1, 0}, c + Vec3{1, -1, 0}}),
        Rgb{x < 0 ? 1e-6f : 1e6f});
  }
  const LightPrimitives lights(s);
  const LightTree tree(lights);
  for (const float x : {-3.0f, 0.0f, 3.0f}) {
    double sum = 0;
    for (const uint32_t p : {0u, 1u}) {
      CHECK(tree.pmf({x, 0, 0}, {0, 0, 1}, false, p) > 0);
      sum += double(tree.pmf({x, 0, 0}, {0, 0, 1}, false, p));
    }
    CHECK(sum == doctest::Approx(1).epsilon(1e-6));
  }
}

TEST_CASE("probabilities follow irradiance: the near source is preferred") {
  Scene s;
  const uint32_t m = add_diffuse(s, Rgb{0});
  for (const float x : {0.0f, 10.0f}) add_disk_light(s, m, {x, 0, 2}, {0, 0, -1}, 0.5f, Rgb{1});
  const LightPrimitives lights(s);
  const LightTree tree(lights);
  CHECK(tree.pmf({0, 0, 0}, {0, 0, 1}, false, 0) > 0.95f);
  CHECK(tree.pmf({10, 0, 0}, {0, 0, 1}, false, 1) > 0.95f);
  CHECK(tree.pmf({5, 0, 0}, {0, 0, 1}, false, 0) == doctest::Approx(0.5).epsilon(0.01));
  // The normal faces away from both.
  CHECK(tree.choose({5, 0, 0}, {0, 0, -1}, false, 0.3f).pmf == 0);
  CHECK(tree.choose({5, 0, 0}, {0, 0, -1}, true, 0.3f).pmf > 0);
  // Above both, on their back sides.
  CHECK(tree.choose({5, 0, 9}, {0, 0, -1}, false, 0.3f).pmf == 0);
}

TEST_CASE("no source, one source, black sources") {
  Scene s;
  const uint32_t m = add_diffuse(s, Rgb{0});
  {
    const LightPrimitives lights(s);
    const LightTree tree(lights);
    CHECK(tree.is_empty());
    CHECK(tree.choose({0, 0, 0}, {0, 0, 1}, false, 0.5f).pmf == 0);
  }
  add_disk_light(s, m, {0, 0, 2}, {0, 0, -1}, 0.5f, Rgb{0});
  {
    const LightPrimitives lights(s);
    const LightTree tree(lights);
    CHECK(tree.is_empty());
  }
  add_disk_light(s, m, {0, 0, 2}, {0, 0, -1}, 0.5f, Rgb{1});
  const LightPrimitives lights(s);
  const LightTree tree(lights);
  REQUIRE(lights.size() == 1);
  const LightChoice c = tree.choose({0, 0, 0}, {0, 0, 1}, false, 0.25f);
  CHECK(c.primitive == 0);
  CHECK(c.pmf == 1);
  CHECK(c.u == 0.25f);
  CHECK(tree.pmf({0, 0, 0}, {0, 0, 1}, false, 0) == 1);
}

TEST_CASE("sources at one place have equal shares") {
  Scene s;
  const uint32_t m = add_diffuse(s, Rgb{0});
  constexpr uint32_t n = 100;
  for (uint32_t i = 0; i < n; ++i) add_disk_light(s, m, {1, 2, 3}, {0, 0, -1}, 0.5f, Rgb{1});
  const LightPrimitives lights(s);
  const LightTree tree(lights);
  for (uint32_t p = 0; p < n; ++p) {
    const float pmf = tree.pmf({0, 0, 0}, {0, 0, 1}, false, p);
    CHECK(double(pmf) == doctest::Approx(1.0 / n).epsilon(0.5));
  }
  CHECK(sum_of_pmf(tree, lights, {{0, 0, 0}, {0, 0, 1}}, false) ==
        doctest::Approx(1).epsilon(1e-4));
}

TEST_CASE("a tree over the primitives of a single emitter") {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const Scene scene = random_lights(seed + 700, 20);
    const LightPrimitives lights(scene);
    Random r(seed + 5000);
    for (uint32_t e = 0; e < scene.lights.size(); ++e) {
      const LightPrimitives::Range range = lights.of_light(e);
      const LightTree tree(lights, range);
      CHECK(tree.is_empty() == (range.first == range.last));
      for (int i = 0; i < 20; ++i) {
        const Receiver at = random_receiver(lights, r);
        const LightChoice c = tree.choose(at.position, at.normal, false, r.next_float());
        double sum = 0;
        for (uint32_t p = range.first; p < range.last; ++p) {
          const float pmf = tree.pmf(at.position, at.normal, false, p);
          sum += double(pmf);
          if (exact(lights[p], at, false) > 1e-10) CHECK(pmf > 0);
        }
        CHECK(sum < 1 + 1e-5);
        if (c.pmf == 0) continue;
        CHECK(c.primitive >= range.first);
        CHECK(c.primitive < range.last);
        CHECK(is_same(c.pmf, tree.pmf(at.position, at.normal, false, c.primitive)));
      }
    }
  }
}

TEST_CASE("a tree of ten thousand primitives is built quickly, and all are reachable") {
  // In a row by powers of two, which makes the most unbalanced splits, and scattered at random.
  for (const bool is_strung : {false, true}) {
    Scene s;
    const uint32_t m = add_diffuse(s, Rgb{0});
    Random r(1);
    for (int i = 0; i < 10000; ++i) {
      const Vec3 at = is_strung ? Vec3{std::exp2(float(i % 100) - 50), float(i / 100) * 1e-3f, 2}
                                : random_point(r, 10);
      add_disk_light(s, m, at, {0, 0, -1}, 1e-3f, Rgb{1});
    }
    const LightPrimitives lights(s);
    const ProcessorStopwatch watch;
    const LightTree tree(lights);
    CHECK(watch.seconds() < 1);
    const Receiver at{{0.5f, 0.5f, -30}, {0, 0, 1}};
    CHECK(sum_of_pmf(tree, lights, at, false) == doctest::Approx(1).epsilon(1e-3));
    for (uint32_t p = 0; p < lights.size(); ++p)
      if (exact(lights[p], at, false) > 1e-20)
        REQUIRE(tree.pmf(at.position, at.normal, false, p) > 0);
    int nothing = 0;
    for (int i = 0; i < 10000; ++i) {
      const LightChoice c = tree.choose(at.position, at.normal, false, r.next_float());
      if (c.pmf == 0)
        ++nothing;
      else
        REQUIRE(is_same(c.pmf, tree.pmf(at.position, at.normal, false, c.primitive)));
    }
    CHECK(nothing < 10);
  }
}

TEST_CASE("nearby primitives: all within reach, none beyond, and no more than requested") {
  size_t found = 0;
  for (uint64_t seed = 0; seed < 40; ++seed) {
    const Scene scene = random_lights(seed, 1 + int(seed * 7 % 50));
    const LightPrimitives lights(scene);
    const LightTree tree(lights);
    Random r(seed + 2000);
    std::vector<uint32_t> near;
    for (int i = 0; i < 40; ++i) {
      const Vec3 x = random_receiver(lights, r).position;
      const float reach = 5 * r.next_float();
      tree.near(x, reach, lights.size() + 1, near);
      for (uint32_t p = 0; p < lights.size(); ++p) {
        if (lights[p].is_infinite()) continue;
        const Box& b = lights[p].bounds;
        const float away = length(max(max(b.lower - x, x - b.upper), Vec3(0)));
        const float beyond = length(x - b.centre()) - b.diagonal() / 2;
        const auto times = std::count(near.begin(), near.end(), p);
        if (away < reach * 0.9999f) CHECK(times == 1);
        if (beyond > reach * 1.0001f + 1e-4f) CHECK(times == 0);
      }
      found += near.size();
      const size_t all = near.size();
      tree.near(x, reach, 2, near);
      CHECK(near.size() == std::min<size_t>(all, 2));
    }
  }
  CHECK(found > 1000);
}

TEST_CASE("choosing for many points equals choosing for each") {
  Random random(23);
  for (const size_t sources : {1u, 3u, 40u}) {
    Scene s;
    for (size_t i = 0; i < sources; ++i)
      test::add_ceiling_light(s, 0.1f + random.next_float(), 1 + 3 * random.next_float(),
                              Rgb{random.next_float() + 0.1f});
    const LightPrimitives lights(s);
    const LightTree tree(lights);
    constexpr size_t n = 999;
    LightReceivers receivers;
    receivers.resize(n);
    std::vector<Vec3> points(n), normals(n);
    std::vector<float> u(n);
    for (size_t i = 0; i < n; ++i) {
      points[i] = sphere_from_square(random.next_vec2()) * (4 * random.next_float());
      normals[i] = sphere_from_square(random.next_vec2());
      u[i] = random.next_float();
      receivers.set(i, points[i], normals[i], i % 3 == 0, u[i]);
    }
    std::vector<LightChoice> many(n);
    std::vector<float> scratch;
    tree.choose_many(receivers, many.data(), scratch);
    size_t different = 0;
    for (size_t i = 0; i < n; ++i) {
      const LightChoice one = tree.choose(points[i], normals[i], i % 3 == 0, u[i]);
      different += one.pmf != many[i].pmf || one.u != many[i].u ||
                   (one.pmf > 0 && one.primitive != many[i].primitive);
    }
    CHECK(different == 0);
  }
}

TEST_CASE("choosing by increasing numbers for one point equals choosing by each") {
  Random random(29);
  for (const size_t sources : {1u, 3u, 40u, 700u}) {
    Scene s;
    for (size_t i = 0; i < sources; ++i)
      test::add_ceiling_light(s, 0.1f + random.next_float(), 1 + 3 * random.next_float(),
                              Rgb{random.next_float() + 0.1f});
    const LightPrimitives lights(s);
    const LightTree tree(lights);
    size_t different = 0, without = 0;
    for (int at = 0; at < 50; ++at) {
      const Vec3 x = sphere_from_square(random.next_vec2()) * (4 * random.next_float());
      const Vec3 n = sphere_from_square(random.next_vec2());
      std::vector<float> u(64);
      for (float& v : u) v = random.next_float();
      std::sort(u.begin(), u.end());
      std::vector<LightChoice> sorted(u.size());
      tree.choose_sorted(x, n, at % 3 == 0, u.data(), u.size(), sorted.data());
      for (size_t i = 0; i < u.size(); ++i) {
        const LightChoice one = tree.choose(x, n, at % 3 == 0, u[i]);
        without += one.pmf == 0;
        different += one.pmf != sorted[i].pmf || one.u != sorted[i].u ||
                     (one.pmf > 0 && one.primitive != sorted[i].primitive);
      }
    }
    CHECK(different == 0);
    CHECK(without < 50 * 64);
  }
}
