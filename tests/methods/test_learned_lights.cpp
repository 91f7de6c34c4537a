// Choice of lights by what arrives from them (select/learned_lights.h, transport/light_training.h).
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "base/random.h"
#include "light/light.h"
#include "probe.h"
#include "support/surfaceless_lights.h"
#include "transport/light_training.h"

using namespace troffer;
using namespace troffer::test;

namespace test_learned_lights {

namespace {

// A sun, and a sky whose upper part is bright and blue, and grey below the horizon.
void add_sun_and_sky(Scene& s) {
  Light& sun = add_light(s, LightKind::sun, Rgb{4e4f});
  sun.direction = normalize(Vec3{-0.9f, 0.2f, -0.5f});
  sun.angular_radius = 0.0047f;
  Light& sky = add_light(s, LightKind::sky, Rgb{1, 1.2f, 1.6f});
  sky.direction = sun.direction;
  sky.sky = {-1, -0.32f, 10, -3, 0.45f, 1, Rgb{0.2f}};
}

// A room of 4 × 4 × 3 m under sun and sky, open to them by a hole of 1 × 1 m in the wall x = 2. A
// panel lights it from the ceiling.
Scene room_with_window(const Material& of_floor) {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f}), floor = add_material(s, of_floor);
  add_sun_and_sky(s);
  add_ceiling_light(s, 0.5f, 2.9f, Rgb{1});
  add_quad(s, floor, {Vec3{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
  add_quad(s, grey, {Vec3{-2, -2, 3}, {-2, 2, 3}, {2, 2, 3}, {2, -2, 3}});
  add_quad(s, grey, {Vec3{-2, -2, 0}, {-2, 2, 0}, {-2, 2, 3}, {-2, -2, 3}});
  add_quad(s, grey, {Vec3{-2, -2, 0}, {-2, -2, 3}, {2, -2, 3}, {2, -2, 0}});
  add_quad(s, grey, {Vec3{-2, 2, 0}, {2, 2, 0}, {2, 2, 3}, {-2, 2, 3}});
  add_quad(s, grey, {Vec3{2, -2, 0}, {2, -2, 1}, {2, 2, 1}, {2, 2, 0}});
  add_quad(s, grey, {Vec3{2, -2, 2}, {2, -2, 3}, {2, 2, 3}, {2, 2, 2}});
  add_quad(s, grey, {Vec3{2, -2, 1}, {2, -2, 2}, {2, -0.5f, 2}, {2, -0.5f, 1}});
  add_quad(s, grey, {Vec3{2, 0.5f, 1}, {2, 0.5f, 2}, {2, 2, 2}, {2, 2, 1}});
  return s;
}

Material matte() {
  Material m;
  m.base_color.value = Rgb{0.6f, 0.5f, 0.4f};
  return m;
}
Material coated() {
  Material m;
  m.kind = MaterialKind::coated_diffuse;
  m.base_color.value = Rgb{0.5f};
  m.roughness.value = 0.3f;
  return m;
}

// Viewing rays from the middle of the room in all directions.
ViewingRays rays_around(uint32_t batch) {
  ViewingRays rays;
  for (uint32_t i = 0; i < 256; ++i) {
    rays.streams.push_back(hash_of(uint64_t{batch}, uint64_t{i}));
    rays.samples.push_back(0);
    const Vec2 u = SobolGroup(rays.streams.back(), 0, 0).get2(0);
    const float z = 1 - 2 * u.x, r = std::sqrt(std::max(1 - z * z, 0.0f)), phi = 2 * pi_f * u.y;
    Ray ray;
    ray.origin = {0, 0, 1.5f};
    ray.direction = {r * std::cos(phi), r * std::sin(phi), z};
    rays.rays.push_back(ray);
  }
  return rays;
}

std::shared_ptr<const LearnedLights> learned_in(const PreparedScene& scene, int threads = 2,
                                                double budget = 3e5) {
  Counters counters;
  return learn_lights(scene, rays_around, budget, threads, counters);
}

Moments seen_from(const PreparedScene& scene, const Vec3& x, const LightSampling& lights,
                  bool is_direct_only, uint32_t samples, int sets) {
  PathOptions o;
  o.lights = lights;
  o.is_direct_only = is_direct_only;
  const Probed p = probe(PathIntegrator(scene, o), ray_towards({0.2f, 0, 1.5f}, x), samples, sets);
  return is_direct_only ? p.direct : p.total;
}

const std::vector<Vec3> places{{-1.5f, 0.3f, 0}, {1.2f, -1, 0}, {-2, 0.5f, 1.2f}, {0.5f, 2, 2}};

}  // namespace

TEST_CASE("paths by learned lights have the same mean") {
  for (const Material& floor : {matte(), coated()}) {
    const PreparedScene scene(room_with_window(floor));
    const LightSampling learned{1, learned_in(scene)}, several{4, learned.learned};
    for (const Vec3& x : places) {
      CAPTURE(x.x);
      const Moments plain = seen_from(scene, x, {}, false, 4096, 32);
      for (const LightSampling& l : {learned, several}) {
        const Moments m = seen_from(scene, x, l, false, 1024, 32);
        CHECK(m.standard_error() < 0.02 * plain.mean());
        CHECK(std::abs(m.mean() - plain.mean()) <
              4 * std::hypot(m.standard_error(), plain.standard_error()));
      }
    }
  }
}

TEST_CASE("learned lights lower the noise of light through a window") {
  const PreparedScene scene(room_with_window(matte()));
  const LightSampling learned{1, learned_in(scene)};
  double plain = 0, by_learned = 0;
  for (const Vec3& x : places) {
    const double mean = seen_from(scene, x, {}, true, 4096, 16).mean();
    plain += sqr(seen_from(scene, x, {}, true, 1, 4000).standard_error() / mean);
    by_learned += sqr(seen_from(scene, x, learned, true, 1, 4000).standard_error() / mean);
  }
  CHECK(by_learned < 0.5 * plain);
}

// The mean of 1 / density over samples is the measure of what is sampled: for the sky, 4 pi.
TEST_CASE("the probability of a choice is that of the light and the direction") {
  const PreparedScene scene(room_with_window(matte()));
  const std::shared_ptr<const LearnedLights> learned = learned_in(scene);
  const Vec3 x{-1.5f, 0.3f, 0}, n{0, 0, 1};
  Moments solid_angle, others;
  Random random(3);
  for (int i = 0; i < 200000; ++i) {
    const float u = random.next_float();
    const Vec2 square{random.next_float(), random.next_float()};
    const LearnedLights::Choice c = learned->choose(x, n, false, u, square);
    double inverse = 0, other = 0;
    if (c.light.pmf > 0) {
      const LightPrimitive& p = scene.primitives[c.light.primitive];
      const bool is_sky = has_square_of_direction(scene.scene, p);
      LightSample s;
      REQUIRE((sample(scene.scene, p, x, c.square, s) || !is_sky));
      if (is_sky) {
        inverse = 1 / (double(c.light.pmf) * double(s.pdf_solid_angle));
        CHECK(double(learned->pmf_at_infinity(x, n, false, c.light.primitive, s.wi)) ==
              doctest::Approx(double(c.light.pmf)).epsilon(0.01));
      } else if (p.is_infinite()) {
        CHECK(learned->pmf_at_infinity(x, n, false, c.light.primitive, s.wi) == c.light.pmf);
      } else {
        other = 1 / double(c.light.pmf);
        const double of_tree = double(scene.light_tree.pmf(x, n, false, c.light.primitive));
        CHECK(of_tree * double(learned->factor_of_placed(x, n, false)) ==
              doctest::Approx(double(c.light.pmf)).epsilon(1e-5));
      }
    }
    solid_angle.add(inverse);
    others.add(other);
  }
  CHECK(std::abs(solid_angle.mean() - 4 * pi) < 4 * solid_angle.standard_error());
  CHECK(solid_angle.standard_error() < 0.05 * 4 * pi);
  CHECK(std::abs(others.mean() - 1) < 4 * others.standard_error() + 1e-6);  // one panel
}

TEST_CASE("what is learned does not depend on threads, and little light harms nothing") {
  const PreparedScene scene(room_with_window(matte()));
  const auto one = learned_in(scene, 1), three = learned_in(scene, 3);
  REQUIRE(one->regions() == three->regions());
  CHECK(one->regions() > 12);
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 x{4 * random.next_float() - 2, 4 * random.next_float() - 2, 0};
    const Vec2 square{random.next_float(), random.next_float()};
    const float u = random.next_float();
    const auto a = one->choose(x, {0, 0, 1}, false, u, square),
               b = three->choose(x, {0, 0, 1}, false, u, square);
    CHECK(a.light.pmf == b.light.pmf);
    CHECK(a.square.x == b.square.x);
  }
  // A closed room: all samples are in vain, or the panel brings all light.
  for (const bool has_panel : {false, true}) {
    Scene s;
    add_sun_and_sky(s);
    add_box_inside(s, add_diffuse(s, Rgb{0.5f}), {-2, -2, 0}, {2, 2, 3});
    if (has_panel) add_ceiling_light(s, 0.5f, 2.9f, Rgb{1});
    const PreparedScene closed(std::move(s));
    const LightSampling learned{1, learned_in(closed)};
    const Moments m = seen_from(closed, {-1, 0.3f, 0}, learned, true, 1, 1000),
                  plain = seen_from(closed, {-1, 0.3f, 0}, {}, true, 1, 1000);
    if (!has_panel) CHECK(m.mean() == 0);
    if (has_panel) CHECK(m.standard_error() < 0.7 * plain.standard_error());
  }
}

TEST_CASE("lights are learned where it may help") {
  const auto may = [](const auto& add) {
    Scene s;
    add_quad(s, add_diffuse(s, Rgb{0.5f}), {Vec3{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}});
    add(s);
    return may_learn_lights(PreparedScene(std::move(s)));
  };
  CHECK(may(add_sun_and_sky));
  CHECK(may([](Scene& s) { add_environment(s, Rgb{1}); }));
  CHECK_FALSE(may([](Scene& s) { add_distant(s, {0, 0, -1}, Rgb{1}); }));
  CHECK_FALSE(may([](Scene& s) {
    for (int i = 0; i < 17; ++i) add_environment(s, Rgb{1});
  }));
  CHECK_FALSE(may([](Scene& s) { add_ceiling_light(s, 1, 2, Rgb{1}); }));
}

}  // namespace test_learned_lights
