// sample_many() against sample(): the same points and densities, independent of the batch.
#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "base/random.h"
#include "base/warp.h"
#include "light/light_points.h"
#include "light/light_sample.h"
#include "support/scenes.h"

using namespace troffer;

namespace {

// Adds a two-sided parallelogram and a sphere.
void add_slanted_and_round(Scene& s) {
  const uint32_t black = test::add_diffuse(s, Rgb{0});
  test::make_light(
      s, test::add_quad(s, black, {Vec3{0, 0, 3}, {1, 0.5f, 3}, {1.2f, 1.5f, 3}, {0.2f, 1, 3}}),
      Rgb{1}, true);
  s.spheres.push_back({{2, 0, 1}, 0.3f, false, black, int32_t(s.lights.size())});
  Light sphere;
  sphere.kind = LightKind::sphere;
  sphere.radiance = Rgb{1};
  s.lights.push_back(sphere);
}

}  // namespace

TEST_CASE("many points at once equal those chosen one by one") {
  Scene s;
  test::add_ceiling_light(s, 1, 2, Rgb{1});
  test::add_ceiling_light(s, 0.01f, 1, Rgb{1});
  add_slanted_and_round(s);
  const LightPrimitives lights(s);
  REQUIRE(lights.size() == 4);

  constexpr size_t n = 5000;
  Random random(17);
  std::vector<uint32_t> primitives(n);
  std::vector<Vec3> receivers(n);
  std::vector<float> u(n), v(n);
  for (size_t i = 0; i < n; ++i) {
    primitives[i] = random.next_u32() % 4;
    // Near and far, above and below, and close to the light's plane.
    const float r = 4 * random.next_float() * random.next_float();
    receivers[i] = sphere_from_square(random.next_vec2()) * r + Vec3{0, 0, 2};
    u[i] = random.next_float();
    v[i] = random.next_float();
  }
  std::vector<LightSample> many(n);
  std::vector<uint8_t> is_valid(n, 2);
  LightSampleScratch scratch;
  sample_many(lights, n, primitives.data(), receivers.data(), u.data(), v.data(), many.data(),
              is_valid.data(), scratch);
  size_t valid = 0;
  for (size_t i = 0; i < n; ++i) {
    const LightPrimitive& p = lights[primitives[i]];
    LightSample one;
    REQUIRE(sample(p, receivers[i], {u[i], v[i]}, one) == (is_valid[i] != 0));
    if (is_valid[i] == 0) continue;
    ++valid;
    CHECK(length(one.point - many[i].point) <= 1e-4f * p.radius);
    CHECK(length(one.wi - many[i].wi) <= 1e-4f);
    CHECK(many[i].pdf_solid_angle == doctest::Approx(one.pdf_solid_angle).epsilon(1e-4));
    CHECK(many[i].is_front == one.is_front);
    CHECK(many[i].pdf_solid_angle ==
          doctest::Approx(pdf_solid_angle(p, receivers[i], many[i].wi, many[i].distance))
              .epsilon(1e-3));
  }
  CHECK(valid > n / 3);

  // Alone in a batch, a point must have the same bits.
  for (size_t i = 0; i < 300; ++i) {
    LightSample alone;
    uint8_t ok = 2;
    sample_many(lights, 1, &primitives[i], &receivers[i], &u[i], &v[i], &alone, &ok, scratch);
    REQUIRE(ok == is_valid[i]);
    if (ok == 0) continue;
    CHECK(alone.point == many[i].point);
    CHECK(alone.pdf_solid_angle == many[i].pdf_solid_angle);
  }
}

TEST_CASE("points for one receiver equal those chosen one by one") {
  Scene s;
  test::add_ceiling_light(s, 1, 2, Rgb{1});
  add_slanted_and_round(s);
  const LightPrimitives lights(s);
  Random random(31);
  constexpr size_t n = 32;
  size_t faced = 0, turned = 0;
  for (int at = 0; at < 600; ++at) {
    const LightPrimitive& p = lights[random.next_u32() % 3];
    const float r = at % 5 == 0 ? 100 : 4;  // sampling by area, or by solid angle
    const Vec3 x =
        sphere_from_square(random.next_vec2()) * (r * random.next_float()) + Vec3{0, 0, 2};
    std::vector<float> u(n), v(n);
    for (size_t i = 0; i < n; ++i) {
      u[i] = random.next_float();
      v[i] = random.next_float();
    }
    LightPoints points;
    const bool is_any = sample_points(p, x, n, u.data(), v.data(), points);
    const Vec3 normal = sphere_from_square(random.next_vec2());
    float highest = -1;
    for (size_t i = 0; i < n; ++i) {
      LightSample one;
      if (!sample(p, x, {u[i], v[i]}, one)) {
        CHECK((!is_any || points.inverse_pdf[i] == 0));
        continue;
      }
      ++faced;
      REQUIRE(is_any);
      const Vec3 d{points.x[i], points.y[i], points.z[i]};
      CHECK(length(d - one.wi * one.distance) <= 1e-4f * p.radius + 1e-6f * one.distance);
      CHECK(length(Vec3{points.nx[i], points.ny[i], points.nz[i]} - one.normal) <= 1e-5f);
      CHECK(points.inverse_pdf[i] * one.pdf_solid_angle == doctest::Approx(1).epsilon(2e-4));
      highest = std::max(highest, dot(one.wi, normal));
    }
    if (is_below_horizon(p, x, normal)) {
      ++turned;
      CHECK(highest <= 1e-4f);
    }
  }
  CHECK(faced > 5000);
  CHECK(turned > 50);
}
