// Several light samples at first hits of paths, and their number.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "base/random.h"
#include "methods/path_forecast.h"
#include "probe.h"
#include "support/surfaceless_lights.h"

using namespace troffer;
using namespace troffer::test;

namespace test_light_samples {

namespace {

const Vec3 eye{0.3f, 1, 1.2f};
const std::vector<Vec3> targets{{0, -0.5f, 0}, {0.9f, 0.2f, 0}, {-1.5f, 1, 0}};

// A floor under a sky and a panel, which a plate hides in part, and a wall that reflects.
PreparedScene lit_floor(const Material& floor) {
  Scene s;
  const uint32_t black = add_diffuse(s, Rgb{0}), grey = add_diffuse(s, Rgb{0.5f}),
                 material = add_material(s, floor);
  add_ceiling_light(s, 1.2f, 2, Rgb{3, 4, 5});
  add_environment(s, Rgb{0.3f});
  add_quad(s, material, {Vec3{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}});
  add_quad(s, grey, {Vec3{-5, -2, 0}, {5, -2, 0}, {5, -2, 2}, {-5, -2, 2}});
  add_quad(
      s, black,
      {Vec3{-0.4f, -0.4f, 1.2f}, {-0.4f, 0.4f, 1.2f}, {0.4f, 0.4f, 1.2f}, {0.4f, -0.4f, 1.2f}});
  return PreparedScene(std::move(s));
}

Material matte_floor() {
  Material m;
  m.base_color.value = Rgb{0.7f, 0.6f, 0.5f};
  return m;
}
Material coated_floor() {
  Material m;
  m.kind = MaterialKind::coated_diffuse;
  m.base_color.value = Rgb{0.5f};
  m.roughness.value = 0.3f;
  return m;
}

Moments seen(const PreparedScene& scene, const Vec3& x, uint32_t light_samples, uint32_t samples,
             int sets) {
  PathOptions o;
  o.lights.samples_at_first = light_samples;
  return probe(PathIntegrator(scene, o), ray_towards(eye, x), samples, sets).total;
}

}  // namespace

TEST_CASE("any number of light samples at first hits has the same mean") {
  for (const Material& floor : {matte_floor(), coated_floor()}) {
    const PreparedScene scene = lit_floor(floor);
    for (const Vec3& x : targets) {
      CAPTURE(x.x);
      const Moments one = seen(scene, x, 1, 1024, 32);
      CHECK(one.standard_error() < 0.004 * one.mean());
      for (const uint32_t n : {4u, 16u}) {
        const Moments several = seen(scene, x, n, 256, 32);
        CHECK(several.standard_error() < 0.004 * one.mean());
        CHECK(std::abs(several.mean() - one.mean()) <
              4 * std::hypot(one.standard_error(), several.standard_error()));
      }
    }
  }
}

TEST_CASE("light samples at first hits lower the noise of single paths") {
  const PreparedScene scene = lit_floor(matte_floor());
  for (const Vec3& x : targets) {
    CAPTURE(x.x);
    // Four independent samples would halve the part of the noise that they share.
    CHECK(seen(scene, x, 4, 1, 8000).standard_error() <
          0.8 * seen(scene, x, 1, 1, 8000).standard_error());
  }
}

TEST_CASE("the number of light samples is that of least variance × cost") {
  Random r(7);
  const auto number = [&] { return std::exp(8 * double(r.next_float()) - 4); };
  for (int i = 0; i < 1000; ++i) {
    const double rest = number(), shared = number(), path = number(), sample = number();
    const auto test = [&](double n) { return PathTest{rest + shared / n, path + sample * n}; };
    const auto work = [&](uint32_t n) { return test(n).variance * test(n).cost; };
    const uint32_t chosen = cheapest_light_samples(test(1), test(few_light_samples));
    double least = work(1);
    for (uint32_t n = 2; n <= most_light_samples; n *= 2) least = std::min(least, work(n));
    CHECK(work(chosen) <= least * (1 + 1e-9));
  }
}

TEST_CASE("light samples that do not help, or whose test shows more noise, are not taken") {
  CHECK(cheapest_light_samples({1, 1}, {1, 2}) == 1);
  CHECK(cheapest_light_samples({1, 1}, {2, 2}) == 1);
  CHECK(cheapest_light_samples({0, 1}, {0, 2}) == 1);
  // All noise is theirs, and they are cheap.
  CHECK(cheapest_light_samples({1, 1}, {1.0 / few_light_samples, 1.01}) == most_light_samples);
}

}  // namespace test_light_samples
