// One shadow ray from each hit of a path, to one of several candidates.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "probe.h"

using namespace troffer;
using namespace troffer::test;

namespace test_resampled_direct {

namespace {

const Vec3 eye{0.3f, 1, 1.2f};
const std::vector<Vec3> targets{{0, -0.5f, 0}, {0.9f, 0.2f, 0}, {-1.5f, 1, 0}};

// Adds one of several rectangles above the floor z = 0, none of which hides another: a near panel,
// a small one far away, one that shines both ways, and an upright one that the floor's plane cuts.
void add_light(Scene& s, uint32_t black, int which) {
  const Vec3 a{6, 6, 4}, x{0.05f, 0, 0}, y{0, -0.05f, 0};
  switch (which) {
    case 0:
      return add_ceiling_light(s, 1.2f, 2, Rgb{3, 4, 5});
    case 1:
      return make_light(s, add_quad(s, black, {a, a + y, a + x + y, a + x}), Rgb{4000}, false);
    case 2:
      return make_light(
          s, add_quad(s, black, {Vec3{-3, 0, 1}, {-2, 0, 1}, {-2, 1, 1.3f}, {-3, 1, 1.3f}}),
          Rgb{1, 1, 2}, true);
    default:
      return make_light(s, add_quad(s, black, {Vec3{2, -1, -1}, {2, -1, 1}, {2, 1, 1}, {2, 1, -1}}),
                        Rgb{2}, true);
  }
}

Scene floor_with(const std::vector<int>& lights, const Material& floor) {
  Scene s;
  const uint32_t black = add_diffuse(s, Rgb{0}), material = add_material(s, floor);
  for (const int which : lights) add_light(s, black, which);
  add_quad(s, material, {Vec3{-20, -20, 0}, {20, -20, 0}, {20, 20, 0}, {-20, 20, 0}});
  // Hides some of the light.
  add_quad(s, black,
           {Vec3{0.4f, 0.4f, 1.6f}, {0.4f, 0.9f, 1.6f}, {0.9f, 0.9f, 1.6f}, {0.9f, 0.4f, 1.6f}});
  return s;
}

Material matte() {
  Material m;
  m.base_color.value = Rgb{0.7f, 0.6f, 0.5f};
  return m;
}
Material coated() {
  Material m;
  m.kind = MaterialKind::coated_diffuse;
  m.base_color.value = Rgb{0.5f};
  m.roughness.value = 0.2f;
  return m;
}

Moments direct_light(Scene scene, const Vec3& x, uint32_t samples, int sets) {
  const PreparedScene prepared(std::move(scene));
  PathOptions o;
  o.is_direct_only = true;
  return probe(PathIntegrator(prepared, o), ray_towards(eye, x), samples, sets).total;
}

}  // namespace

TEST_CASE("resampled lights together give the sum of single lights") {
  const std::vector<int> lights{0, 1, 2, 3};
  REQUIRE(ResampledDirect::suits(PreparedScene(floor_with(lights, matte()))));
  for (const Material& floor : {matte(), coated()})
    for (const Vec3& x : targets) {
      double sum = 0, variance = 0;
      for (const int which : lights) {
        const Moments one = direct_light(floor_with({which}, floor), x, 512, 16);
        sum += one.mean();
        variance += one.standard_error() * one.standard_error();
      }
      CAPTURE(x.x);
      const Moments all = direct_light(floor_with(lights, floor), x, 1024, 16);
      CHECK(std::abs(all.mean() - sum) <
            5 * std::sqrt(variance + all.standard_error() * all.standard_error()) + 2e-5 * sum);
      CHECK(all.standard_error() < 0.01 * sum);
    }
}

// Four equal panels in full view: the remaining noise comes from the choice of points on a panel.
TEST_CASE("a ray to one of several lights estimates the light of all") {
  Scene s;
  const uint32_t black = add_diffuse(s, Rgb{0}), grey = add_diffuse(s, Rgb{0.5f});
  for (const float x : {-2.0f, 1.0f})
    for (const float y : {-2.0f, 1.0f})
      make_light(
          s, add_quad(s, black, {Vec3{x, y, 2}, {x, y + 1, 2}, {x + 1, y + 1, 2}, {x + 1, y, 2}}),
          Rgb{x < 0 ? 5.0f : 1.0f}, false);
  add_quad(s, grey, {Vec3{-20, -20, 0}, {20, -20, 0}, {20, 20, 0}, {-20, 20, 0}});
  const Moments one = direct_light(std::move(s), {0.4f, 0.3f, 0}, 1, 4000);
  // Spread of single values, from the error of the mean of 4000.
  CHECK(one.standard_error() * std::sqrt(4000.0) < 0.2 * one.mean());
}

}  // namespace test_resampled_direct
