// Paths that choose directions of the sky by the openings of a room.
#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "methods/openings_training.h"
#include "probe.h"
#include "support/surfaceless_lights.h"

using namespace troffer;
using namespace troffer::test;

namespace test_openings_of_paths {

namespace {

constexpr float side = 4;

// A room of 4 × 4 × 4 m with a window of 1 × 1 m in its side x = 4 and a thing in it.
Scene room_with(uint32_t (*thing)(Scene&)) {
  Scene s;
  const uint32_t m = add_diffuse(s, Rgb{0.6f});
  const auto wall = [&](float y0, float y1, float z0, float z1) {
    add_quad(s, m, {Vec3{side, y0, z0}, {side, y0, z1}, {side, y1, z1}, {side, y1, z0}});
  };
  wall(0, side, 0, 1);
  wall(0, side, 2, side);
  wall(0, 1, 1, 2);
  wall(2, side, 1, 2);
  add_quad(s, m, {Vec3{0, 0, 0}, {side, 0, 0}, {side, side, 0}, {0, side, 0}});
  add_quad(s, m, {Vec3{0, 0, side}, {0, side, side}, {side, side, side}, {side, 0, side}});
  add_quad(s, m, {Vec3{0, 0, 0}, {0, side, 0}, {0, side, side}, {0, 0, side}});
  add_quad(s, m, {Vec3{0, 0, 0}, {0, 0, side}, {side, 0, side}, {side, 0, 0}});
  add_quad(s, m, {Vec3{0, side, 0}, {side, side, 0}, {side, side, side}, {0, side, side}});
  const uint32_t t = thing(s);
  add_quad(s, t, {Vec3{1, 1, 0.5f}, {2, 1, 0.5f}, {2, 3, 0.5f}, {1, 3, 0.5f}});
  return s;
}

uint32_t matte(Scene& s) {
  return add_diffuse(s, Rgb{0.5f});
}
uint32_t glossy(Scene& s) {
  return add_metal(s, 0.3f);
}

void add_uniform_sky(Scene& s) {
  add_environment(s, Rgb{2});
}
// Darker to the sides, with a bright patch beyond the window.
void add_image(Scene& s) {
  EnvironmentMap map;
  map.projection = SphereMap::lat_long;
  map.width = 32;
  map.height = 16;
  for (int i = 0; i < 32 * 16; ++i) map.texels.push_back(Rgb{i % 32 == 0 ? 40.0f : 1.0f});
  s.environments.push_back(std::move(map));
  add_light(s, LightKind::environment, Rgb{1}).environment = 0;
}
void add_sky_and_lamp(Scene& s) {
  Light& e = add_light(s, LightKind::sky, Rgb{1});
  e.sky.ground = Rgb{0.3f};
  e.direction = normalize(Vec3{-1, 0, -1});
  add_point(s, {2, 2, 3}, Rgb{2});
}

// Looks at the whole room from its corner.
PictureView view_of_room() {
  PictureView view;
  view.image = view.window = {0, 0, 64, 64};
  view.ray = [](float x, float y) {
    Ray r;
    r.origin = {0.2f, 0.2f, 3.5f};
    r.direction = normalize(Vec3{1 + x / 32, 1 + y / 32, -1.2f});
    return r;
  };
  return view;
}

std::shared_ptr<const Openings> trained(const PreparedScene& scene, int threads = 0) {
  PathForecast f;
  f.rays_of_path = 4;
  Counters counters;
  return find_openings(scene, view_of_room(), f, 80'000, 1, threads, counters);
}

void check_alike(const Moments& a, const Moments& b) {
  const double sigma = std::hypot(a.standard_error(), b.standard_error());
  CHECK(std::abs(a.mean() - b.mean()) <= 4.5 * sigma + 1e-5 * a.mean());
}

}  // namespace

TEST_CASE("openings change the noise of paths, not their mean") {
  struct Case {
    void (*add_light)(Scene&);
    uint32_t (*thing)(Scene&);
    double least_gain;  // of the variance of direct light on the floor
  };
  for (const Case& c : {Case{add_uniform_sky, matte, 4}, Case{add_image, matte, 3},
                        Case{add_sky_and_lamp, matte, 1.5}, Case{add_uniform_sky, glossy, 4}}) {
    Scene s = room_with(c.thing);
    c.add_light(s);
    const PreparedScene scene(std::move(s));
    PathOptions options;
    options.openings = trained(scene);
    REQUIRE(options.openings != nullptr);
    const PathIntegrator plain(scene, {}), guided(scene, options);
    for (const Vec3& target : {Vec3{1.5f, 2, 0.5f}, Vec3{3, 2, 0}, Vec3{4, 2, 0.5f}}) {
      const Ray ray = ray_towards({0.5f, 2, 3}, target);
      const Probed a = probe(plain, ray, 64, 256), b = probe(guided, ray, 64, 256, 1);
      printf("%g %g %g: direct %g +- %g, %g +- %g\n", double(target.x), double(target.y), double(target.z), a.direct.mean(), 16*a.direct.standard_error(), b.direct.mean(), 16*b.direct.standard_error());
      check_alike(a.total, b.total);
      check_alike(a.direct, b.direct);
      if (target.z == 0)
        CHECK(a.direct.variance_of_mean() > c.least_gain * b.direct.variance_of_mean());
    }
  }
}

TEST_CASE("openings do not depend on the number of threads, and need a sky") {
  Scene s = room_with(matte);
  add_uniform_sky(s);
  const PreparedScene scene(std::move(s));
  const auto one = trained(scene, 1), two = trained(scene, 2);
  Random r(3);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 x{side * r.next_float(), side * r.next_float(), side * r.next_float()};
    const Vec3 n = random_direction(r), w = random_direction(r);
    CHECK(one->contains(x) == two->contains(x));
    CHECK(one->pdf(x, n, false, w) == two->pdf(x, n, false, w));
  }
  Scene lamp = room_with(matte);
  add_point(lamp, {2, 2, 3}, Rgb{2});
  CHECK(trained(PreparedScene(std::move(lamp))) == nullptr);
}

}  // namespace test_openings_of_paths
