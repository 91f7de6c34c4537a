// Lights that coincide, and lights inside others: every method against the closed form.
#include <doctest/doctest.h>

#include <functional>
#include <string>
#include <vector>

#include "light/irradiance.h"
#include "probe.h"
#include "scene/joined_lights.h"
#include "support/light_scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

struct Case {
  std::string name;
  std::function<void(Scene&)> build;
  std::function<double(const Vec3d& x)> irradiance;  // at a floor
  size_t lights;
  bool is_by_path = true;  // false: rays of `path` may hit either of two panels back to back
};

void add_panel(Scene& s, float half, Rgb radiance, bool is_up, bool is_two_sided) {
  std::array<Vec3, 4> c{Vec3{-half, -half, 2}, {-half, half, 2}, {half, half, 2}, {half, -half, 2}};
  if (is_up) std::reverse(c.begin(), c.end());
  make_light(s, add_quad(s, 0, c), radiance, is_two_sided);
}

double of_sphere(const Vec3d& x, double radius) {
  return sphere_irradiance({0, 0, 2}, radius, x, {0, 0, 1});
}

double of_panel(const Vec3d& x, double half) {
  const std::array<Vec3d, 4> c{
      Vec3d{-half, -half, 2}, {-half, half, 2}, {half, half, 2}, {half, -half, 2}};
  return polygon_irradiance(c, x, {0, 0, 1}, Sides::both);
}

std::vector<Case> cases() {
  const Vec3 at{0, 0, 2};
  return {
      {"two spheres",
       [=](Scene& s) {
         add_sphere_light(s, 0, at, 0.3f, Rgb{3});
         add_sphere_light(s, 0, at, 0.3f, Rgb{5});
       },
       [](const Vec3d& x) { return 8 * of_sphere(x, double(0.3f)); }, 1},
      {"a bright sphere in a dim one",
       [=](Scene& s) {
         add_sphere_light(s, 0, at, 0.1f, Rgb{1000});
         add_sphere_light(s, 0, at, 0.3f, Rgb{3});
       },
       [](const Vec3d& x) { return 3 * of_sphere(x, double(0.3f)); }, 2},
      {"a bright panel in a dim sphere",
       [=](Scene& s) {
         add_panel(s, 0.1f, Rgb{1000}, false, true);
         add_sphere_light(s, 0, at, 0.3f, Rgb{3});
       },
       [](const Vec3d& x) { return 3 * of_sphere(x, double(0.3f)); }, 2},
      {"three panels",
       [](Scene& s) {
         for (const float l : {1.0f, 2.0f, 4.0f}) add_panel(s, 0.5f, Rgb{l}, false, false);
       },
       [](const Vec3d& x) { return 7 * of_panel(x, 0.5); }, 1},
      {"panels that shine down and up",
       [](Scene& s) {
         add_panel(s, 0.5f, Rgb{3}, false, false);
         add_panel(s, 0.5f, Rgb{1000}, true, false);
       },
       [](const Vec3d& x) { return 3 * of_panel(x, 0.5); }, 2, false},
      {"two-sided panels, of which one is turned over",
       [](Scene& s) {
         add_panel(s, 0.5f, Rgb{3}, false, true);
         add_panel(s, 0.5f, Rgb{5}, true, true);
       },
       [](const Vec3d& x) { return 8 * of_panel(x, 0.5); }, 1},
      {"two disks",
       [=](Scene& s) {
         add_disk_light(s, 0, at, {0, 0, -1}, 0.4f, Rgb{3});
         add_disk_light(s, 0, at, {0, 0, -1}, 0.4f, Rgb{5});
       },
       [](const Vec3d& x) {
         return 8 * disk_irradiance({0, 0, 2}, {0, 0, -1}, double(0.4f), x, {0, 0, 1});
       },
       1},
  };
}

}  // namespace

TEST_CASE("coincident and separate lights: every method agrees with the closed form") {
  for (const Case& c : cases()) {
    Scene s;
    add_diffuse(s, Rgb{0.5f});
    add_quad(s, 0, {Vec3{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}});
    c.build(s);
    s = with_joined_lights(std::move(s));
    CAPTURE(c.name);
    CHECK(s.lights.size() == c.lights);
    const PreparedScene scene(std::move(s));
    const WaveIntegrator mine = certified_integrator(scene), fixed = fixed_integrator(scene, 16);
    const PathIntegrator path(scene, PathOptions{1});
    std::vector<const Integrator*> methods{&mine, &fixed};
    if (c.is_by_path) methods.push_back(&path);
    const Vec3 x{0.7f, 0.4f, 0}, eye{0, -3, 1};
    const double expected = 0.5 / pi * c.irradiance(Vec3d(x));
    for (const Integrator* method : methods) {
      const Probed p = probe(*method, ray_towards(eye, x), 256, 32);
      CAPTURE(p.total.mean() / expected);
      CHECK(p_of_mean(p.total, expected, 1e-4 * expected) > 1e-5);
    }
  }
}

TEST_CASE("joined lights are visible with their sum; other lights stay unchanged") {
  Scene s;
  add_diffuse(s, Rgb{0.5f});
  add_quad(s, 0, {Vec3{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}});
  add_sphere_light(s, 0, {3, 0, 1}, 0.2f, Rgb{9});
  add_panel(s, 0.5f, Rgb{1}, false, false);
  add_sphere_light(s, 0, {0, 0, 1}, 0.2f, Rgb{2});
  add_sphere_light(s, 0, {0, 0, 1}, 0.2f, Rgb{5});
  add_panel(s, 0.5f, Rgb{4}, false, false);
  add_sphere_light(s, 0, {-3, 0, 1}, 0.2f, Rgb{3});
  const Scene joined = with_joined_lights(std::move(s));
  REQUIRE(joined.lights.size() == 4);
  REQUIRE(joined.spheres.size() == 3);
  CHECK(joined.warnings.entries().size() == 1);
  const PreparedScene scene(joined);
  const PathIntegrator path(scene, PathOptions{0});
  const auto seen = [&](const Vec3& at) {
    return probe(path, ray_towards({0, -4, 1.5f}, at), 4, 1).total.mean();
  };
  CHECK(seen({3, 0, 1}) == 9);
  CHECK(seen({0, 0, 1}) == 7);
  CHECK(seen({-3, 0, 1}) == 3);
  CHECK(seen({0, 0, 2}) == 5);
}
