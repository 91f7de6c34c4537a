// Environment images, skies, suns and webs: samples are tested against densities, radiance and
// closed forms.
#include <doctest/doctest.h>

#include <cmath>

#include "base/random.h"
#include "light/environment_image.h"
#include "light/light.h"
#include "light/web.h"
#include "support/chi_square.h"
#include "support/light_scenes.h"
#include "support/surfaceless_lights.h"

using namespace troffer;
using namespace troffer::test;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

EnvironmentMap random_map(SphereMap projection, int width, int height, uint64_t seed) {
  EnvironmentMap map;
  map.projection = projection;
  map.width = width;
  map.height = height;
  Random random(seed);
  for (int i = 0; i < width * height; ++i) {
    const float v = random.next_float();
    map.texels.push_back(v < 0.4f && width * height > 8 ? Rgb{0}
                                                        : Rgb{v, v * v, random.next_float()});
  }
  if (width * height > 8) map.texels[size_t(width * height / 3)] = Rgb{3000, 2000, 1000};
  return map;
}

struct Case {
  SphereMap projection;
  int width, height;
};
constexpr Case cases[] = {{SphereMap::lat_long, 16, 8},  {SphereMap::equal_area, 9, 9},
                          {SphereMap::lat_long, 1, 1},   {SphereMap::equal_area, 1, 1},
                          {SphereMap::lat_long, 2, 1},   {SphereMap::equal_area, 2, 2},
                          {SphereMap::lat_long, 37, 100}};

Scene with_map(const EnvironmentMap& map) {
  Scene s;
  add_quad(s, add_diffuse(s, Rgb{0.5f}), {Vec3{-3, -4, 0}, {3, -4, 0}, {3, 4, 0}, {-3, 4, 0}});
  s.environments.push_back(map);
  Light& e = add_light(s, LightKind::environment, Rgb{2});
  e.environment = 0;
  e.axes = {Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{-1, 0, 0}};  // a reflection
  return s;
}

}  // namespace

TEST_CASE("directions of an image follow their density and can be inverted") {
  const double significance = sidak(1e-4, std::size(cases));
  for (const Case& c : cases) {
    CAPTURE(c.width);
    CAPTURE(c.height);
    const DirectionTable table = direction_table(random_map(c.projection, c.width, c.height, 7));
    constexpr size_t nz = 10, na = 20;
    constexpr int n = 100000, fine = 60;
    std::vector<double> observed(nz * na), expected(nz * na);
    Random random(3);
    const auto bin_of = [&](const Vec3& w) {
      const auto z = std::min(nz - 1, size_t((double(w.z) + 1) / 2 * nz));
      const double azimuth = std::atan2(double(w.y), double(w.x)) / (2 * pi);
      return z * na + std::min(na - 1, size_t((azimuth < 0 ? azimuth + 1 : azimuth) * na));
    };
    for (int i = 0; i < n; ++i) {
      const Vec2 u = random.next_vec2();
      float pdf = 0;
      const Vec3 w = table.sample(u, pdf);
      REQUIRE(std::abs(length(w) - 1) < 1e-5f);
      REQUIRE(pdf > 0);
      ++observed[bin_of(w)];
      if (i > 2000) continue;
      // The neighbourhood may lie across a cell's edge.
      CHECK(double(table.pdf(w)) == doctest::Approx(double(pdf)).epsilon(0.02));
      float again = 0;
      CHECK(length(table.sample(table.square_of(w), again) - w) < 0.02f);
    }
    // Uses midpoints in the angle from z, because densities in rows near a pole rise towards it.
    for (size_t z = 0; z < nz; ++z)
      for (size_t a = 0; a < na; ++a)
        for (int i = 0; i < fine * fine; ++i) {
          const double low = std::acos(double(z) / nz * 2 - 1),
                       high = std::acos(double(z + 1) / nz * 2 - 1);
          const double angle = low + (high - low) * (i / fine + 0.5) / fine,
                       azimuth = (double(a) + (i % fine + 0.5) / fine) / na * 2 * pi;
          const double sine = std::sin(angle);
          const Vec3 w(Vec3d{sine * std::cos(azimuth), sine * std::sin(azimuth), std::cos(angle)});
          expected[z * na + a] +=
              n * double(table.pdf(w)) * sine * (low - high) * 2 * pi / (na * double(fine * fine));
        }
    double total = 0;
    for (const double e : expected) total += e / n;
    CHECK(total == doctest::Approx(1).epsilon(2e-3));
    const auto r = chi_square_test(observed, expected, 1, significance);
    CHECK_MESSAGE(r.is_accepted, r.text());
  }
}

TEST_CASE("luminance over density is constant for all samples of an equal-area image") {
  const EnvironmentMap map = random_map(SphereMap::equal_area, 32, 32, 9);
  const DirectionTable table = direction_table(map);
  Random random(4);
  for (int i = 0; i < 5000; ++i) {
    float pdf = 0;
    const Vec3 w = table.sample(random.next_vec2(), pdf);
    CHECK(double(luminance(radiance_towards(map, w)) / pdf) ==
          doctest::Approx(table.integral()).epsilon(5e-3));
  }
}

TEST_CASE("the light of an image agrees with random rays weighted by the same density") {
  for (const Case& c : cases) {
    const Scene s = with_map(random_map(c.projection, c.width, c.height, 11));
    const LightPrimitives lights(s);
    REQUIRE(lights.size() == 1);
    Random random(5);
    Rgb drawn, seen;
    constexpr int n = 40000;
    for (int i = 0; i < n; ++i) {
      LightSample at;
      const Vec2 u = random.next_vec2();
      REQUIRE(sample(s, lights[0], {}, u, at));
      CHECK(at.radiance == radiance_at_infinity(s, lights[0], {}, at.wi));
      CHECK(double(pdf_solid_angle(s, lights[0], {}, at.wi, infinity)) ==
            doctest::Approx(double(at.pdf_solid_angle)).epsilon(0.02));
      drawn += at.radiance / (at.pdf_solid_angle * n);
    }
    for (int i = 0; i < 600; ++i)
      for (int j = 0; j < 600; ++j)
        seen += radiance_at_infinity(
                    s, lights[0], {},
                    sphere_from_square({(float(i) + 0.5f) / 600, (float(j) + 0.5f) / 600})) *
                (4 * pi_f / (600 * 600));
    CAPTURE(c.width);
    CHECK(double(luminance(drawn)) == doctest::Approx(double(luminance(seen))).epsilon(0.02));
    // Flux into the scene's sphere.
    const double r = 0.5 * double(bounds(s).diagonal());
    CHECK(double(lights[0].power) ==
          doctest::Approx(pi * r * r * double(luminance(seen))).epsilon(0.02));
  }
}

TEST_CASE("a black image is no light") {
  EnvironmentMap map = random_map(SphereMap::lat_long, 4, 2, 1);
  for (Rgb& texel : map.texels) texel = Rgb{0};
  const Scene s = with_map(map);
  CHECK(LightPrimitives(s).size() == 0);
}

TEST_CASE("a sky's and a sun's samples: density, radiance, irradiance") {
  Scene s = with_map(random_map(SphereMap::lat_long, 4, 2, 1));
  s.lights.clear();
  Light& sky = add_light(s, LightKind::sky, Rgb{2});
  sky.sky.a = -1;
  sky.sky.b = -0.32f;
  sky.sky.c = 10;
  sky.sky.d = -3;
  sky.sky.e = 0.45f;
  sky.sky.ground = Rgb{0.3f};
  sky.direction = normalize(Vec3{-1, 0.5f, -1});
  Light& sun = add_light(s, LightKind::sun, Rgb{50000});
  sun.direction = normalize(Vec3{1, 0.5f, -1});
  sun.angular_radius = 0.00465f;
  const LightPrimitives lights(s);
  REQUIRE(lights.size() == 2);
  Random random(8);
  double sky_drawn = 0, sky_seen = 0, sun_drawn = 0;
  constexpr int n = 40000;
  for (int i = 0; i < n; ++i) {
    LightSample at;
    REQUIRE(sample(s, lights[0], {}, random.next_vec2(), at));
    CHECK(double(pdf_solid_angle(s, lights[0], {}, at.wi, infinity)) ==
          doctest::Approx(double(at.pdf_solid_angle)).epsilon(0.03));
    sky_drawn += double(at.radiance.g / at.pdf_solid_angle) / n;
    const Vec3 w = sphere_from_square(random.next_vec2());
    sky_seen += double(radiance_at_infinity(s, lights[0], {}, w).g) * 4 * pi / n;
    // Every visible direction can be sampled.
    if (radiance_at_infinity(s, lights[0], {}, w).g > 0)
      CHECK(pdf_solid_angle(s, lights[0], {}, w, infinity) > 0);

    REQUIRE(sample(s, lights[1], {}, random.next_vec2(), at));
    CHECK(at.radiance == radiance_at_infinity(s, lights[1], {}, at.wi));
    CHECK(pdf_solid_angle(s, lights[1], {}, at.wi, infinity) == at.pdf_solid_angle);
    sun_drawn +=
        double(at.radiance.g / at.pdf_solid_angle) * double(dot(at.wi, -sun.direction)) / n;
    CHECK(pdf_solid_angle(s, lights[1], {}, w, infinity) == 0);
  }
  CHECK(sky_drawn == doctest::Approx(sky_seen).epsilon(0.02));
  CHECK(sun_drawn == doctest::Approx(pi * 50000 * std::pow(std::sin(0.00465), 2)).epsilon(1e-4));
}

TEST_CASE("a web interpolates between its angles, and its intensities add up to its flux") {
  LightWeb web;
  web.vertical_angles_rad = {0, 0.6f, 1.2f, 1.8f};
  web.horizontal_angles_rad = {0, 1, 3, 2 * pi_f};
  Random random(6);
  for (int i = 0; i < 16; ++i) web.intensities.push_back(100 * random.next_float());
  for (size_t j = 0; j < 4; ++j) web.intensities[12 + j] = web.intensities[j];
  double sum = 0;
  for (int i = 0; i < 1000; ++i)
    for (int j = 0; j < 1000; ++j)
      sum += double(intensity(
                 web, sphere_from_square({(float(i) + 0.5f) / 1000, (float(j) + 0.5f) / 1000}))) *
             4 * pi / 1e6;
  CHECK(flux(web) == doctest::Approx(sum).epsilon(1e-3));
  CHECK(intensity(web, {0, 0, -1}) == 0);
  const double along = double(intensity(web, {std::sin(0.6f), 0, std::cos(0.6f)}));
  CHECK(along == doctest::Approx(double(web.intensities[1])).epsilon(1e-3));
  Scene s;
  s.webs.push_back(web);
  Light& e = add_light(s, LightKind::point, Rgb{2});
  e.web = 0;
  e.position = {1, 2, 3};
  e.axes = {Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{0, 0, -1}};
  const LightPrimitives lights(s);
  CHECK(double(lights[0].power) == doctest::Approx(2 * sum).epsilon(1e-3));
  LightSample at;
  const Vec3 below = e.position + Vec3{std::sin(0.6f), 0, -std::cos(0.6f)} * 2.0f;
  REQUIRE(sample(s, lights[0], below, {}, at));
  CHECK(double(at.radiance.r) == doctest::Approx(2 * double(web.intensities[1]) / 4).epsilon(1e-3));
  CHECK_FALSE(sample(s, lights[0], e.position + Vec3{0, 0, 1}, {}, at));
}

TEST_CASE("a range fades a point, and glTF's spots fade by a square") {
  Scene s;
  add_point(s, {0, 0, 0}, Rgb{8});
  s.lights[0].range = 4;
  add_spot(s, {0, 0, 0}, {0, 0, -1}, 0.9f, 0.6f, Rgb{8});
  s.lights[1].falloff = SpotFalloff::square;
  const LightPrimitives lights(s);
  LightSample at;
  REQUIRE(sample(s, lights[0], {2, 0, 0}, {}, at));
  CHECK(double(at.radiance.r) == doctest::Approx(2 * (1 - 1 / 16.0)));
  CHECK_FALSE(sample(s, lights[0], {4, 0, 0}, {}, at));
  // A focal distance of 1: 8 / (3 + 1)².
  Scene focused;
  add_point(focused, {0, 0, 0}, Rgb{8});
  focused.lights[0].focal_distance = 1;
  const LightPrimitives focused_lights(focused);
  REQUIRE(sample(focused, focused_lights[0], {3, 0, 0}, {}, at));
  CHECK(double(at.radiance.r) == doctest::Approx(0.5));
  CHECK(at.distance == 3);
  const float cosine = 0.75f;
  REQUIRE(sample(s, lights[1], {std::sqrt(1 - cosine * cosine), 0, -cosine}, {}, at));
  CHECK(double(at.radiance.r) == doctest::Approx(8 * 0.25).epsilon(1e-4));
}
