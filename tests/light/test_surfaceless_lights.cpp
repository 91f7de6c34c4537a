// Point and spot lights and lights at infinity: samples against densities and closed forms, powers
// against quadrature.
#include <doctest/doctest.h>

#include <cmath>

#include "base/random.h"
#include "base/units.h"
#include "base/warp.h"
#include "light/light.h"
#include "light/spot_light.h"
#include "support/chi_square.h"
#include "support/light_scenes.h"
#include "support/surfaceless_lights.h"

using namespace troffer;
using namespace troffer::test;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
const Vec3 lamp{0.5f, -1, 2};

// One light of each kind without surface, over a floor.
Scene one_of_each() {
  Scene s;
  add_quad(s, add_diffuse(s, Rgb{0.5f}), {Vec3{-3, -4, 0}, {3, -4, 0}, {3, 4, 0}, {-3, 4, 0}});
  add_point(s, lamp, {5, 6, 7});
  add_spot(s, lamp, {0.3f, 0.2f, -1}, 0.9f, 0.6f, Rgb{8});
  add_distant(s, {1, 2, -2}, {4, 3, 2});
  add_environment(s, {1, 2, 3});
  return s;
}

}  // namespace

TEST_CASE("an environment's samples follow their density on the sphere and can be inverted") {
  const Scene s = one_of_each();
  const LightPrimitives lights(s);
  const LightPrimitive& p = lights[lights.of_light(3).first];
  constexpr size_t nz = 12, na = 24;
  constexpr int n = 100000;
  // Equal bins of z and azimuth have equal solid angles. Expected counts come from the density.
  std::vector<double> observed(nz * na), expected(nz * na);
  Random random(3);
  double integral = 0;
  for (int i = 0; i < n; ++i) {
    const Vec2 u = random.next_vec2();
    LightSample sample_of;
    REQUIRE(sample(s, p, lamp, u, sample_of));
    const Vec3 wi = sample_of.wi;
    REQUIRE(sample_of.pdf_solid_angle == pdf_solid_angle(s, p, lamp, wi, infinity));
    REQUIRE(sample_of.radiance == radiance_at_infinity(s, p, {}, wi));
    REQUIRE_FALSE(sample_of.is_delta);
    REQUIRE(std::isinf(sample_of.distance));
    const Vec2 back = square_from_sphere(wi);
    REQUIRE(std::abs(back.x - u.x) < 1e-5f);
    REQUIRE(std::abs(back.y - u.y) < 1e-2f);  // near the poles, azimuths are imprecise
    const auto z = std::min(nz - 1, size_t((double(wi.z) + 1) / 2 * nz));
    const double azimuth = std::atan2(double(wi.y), double(wi.x)) / (2 * pi);
    const auto a = std::min(na - 1, size_t((azimuth < 0 ? azimuth + 1 : azimuth) * na));
    ++observed[z * na + a];
  }
  for (size_t z = 0; z < nz; ++z)
    for (size_t a = 0; a < na; ++a) {
      const double cosine = (double(z) + 0.5) / nz * 2 - 1,
                   azimuth = (double(a) + 0.5) / na * 2 * pi;
      const double sine = std::sqrt(1 - cosine * cosine);
      const Vec3 wi(Vec3d{sine * std::cos(azimuth), sine * std::sin(azimuth), cosine});
      const double share = double(pdf_solid_angle(s, p, lamp, wi, infinity)) * 4 * pi / (nz * na);
      integral += share;
      expected[z * na + a] = n * share;
    }
  CHECK(integral == doctest::Approx(1));
  const auto r = chi_square_test(observed, expected, 1, 1e-4);
  CHECK_MESSAGE(r.is_accepted, r.text());
}

TEST_CASE("a point, a spot and a distant light agree with their closed forms") {
  const Scene s = one_of_each();
  const LightPrimitives lights(s);
  Random random(5);
  int in_beam = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 x = random_point(random, 3);
    const Vec3d to = Vec3d(lamp) - Vec3d(x);
    const double d2 = length_squared(to);
    LightSample at;
    REQUIRE(sample(s, lights[0], x, random.next_vec2(), at));
    CHECK(at.is_delta);
    CHECK(at.pdf_solid_angle == 1);
    CHECK(at.point == lamp);
    CHECK(double(at.distance) == doctest::Approx(std::sqrt(d2)));
    CHECK(double(dot(at.wi, Vec3(normalize(to)))) == doctest::Approx(1));
    CHECK(double(at.radiance.g) == doctest::Approx(6 / d2));

    // The spot's axis is (.3, .2, -1); its falloff is a cubic in the cosine between .9 and .6.
    const double cosine = dot(-to, normalize(Vec3d{0.3, 0.2, -1})) / std::sqrt(d2);
    const double t = std::clamp((cosine - 0.6) / 0.3, 0.0, 1.0);
    const double share = t * t * (3 - 2 * t);
    const bool shines = sample(s, lights[1], x, random.next_vec2(), at);
    if (share > 1e-6) {
      REQUIRE(shines);
      CHECK(double(at.radiance.g) == doctest::Approx(8 * share / d2).epsilon(1e-4));
      ++in_beam;
    } else if (cosine < 0.6 - 1e-5) {
      CHECK_FALSE(shines);
    }

    REQUIRE(sample(s, lights[2], x, random.next_vec2(), at));
    CHECK(at.is_delta);
    CHECK(std::isinf(at.distance));
    CHECK(at.radiance == Rgb{4, 3, 2});
    CHECK(length(at.wi + Vec3{1, 2, -2} / 3) < 1e-6f);
    for (uint32_t p = 0; p < 3; ++p) {
      CHECK(pdf_solid_angle(s, lights[p], x, at.wi, infinity) == 0);
      CHECK(radiance_at_infinity(s, lights[p], {}, at.wi).is_black());
    }
  }
  CHECK(in_beam > 100);
}

TEST_CASE("the power of a light without surface is the flux that it sends") {
  const Scene s = one_of_each();
  const LightPrimitives lights(s);
  const Box box = bounds(s);
  const double r = 0.5 * double(box.diagonal());
  // Power of point and spot, by quadrature over directions at distance 1.
  for (uint32_t p : {0u, 1u}) {
    double flux = 0;
    constexpr int n = 400;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const Vec3 w = sphere_from_square({(float(i) + 0.5f) / n, (float(j) + 0.5f) / n});
        LightSample at;
        if (sample(s, lights[p], lamp + w, {}, at))
          flux += double(luminance(at.radiance)) * 4 * pi / (n * n);
      }
    CHECK(double(lights[p].power) == doctest::Approx(flux).epsilon(2e-3));
  }
  CHECK(double(lights[2].power) == doctest::Approx(pi * r * r * double(luminance(Rgb{4, 3, 2}))));
  CHECK(double(lights[3].power) ==
        doctest::Approx(4 * pi * r * r * pi * double(luminance(Rgb{1, 2, 3}))));
}

TEST_CASE("samples of many lights of all kinds equal those of each alone") {
  Scene s = random_lights(4, 12);
  for (const Light& e : one_of_each().lights) s.lights.push_back(e);
  const LightPrimitives lights(s);
  Random random(8);
  constexpr size_t n = 400;
  std::vector<uint32_t> primitives(n);
  std::vector<Vec3> receivers(n);
  std::vector<float> u(n), v(n);
  for (size_t i = 0; i < n; ++i) {
    primitives[i] = random.next_u32() % uint32_t(lights.size());
    receivers[i] = random_point(random, 4);
    u[i] = random.next_float();
    v[i] = random.next_float();
  }
  std::vector<LightSample> many(n);
  std::vector<uint8_t> is_valid(n);
  LightSampleScratch scratch;
  sample_many(s, lights, n, primitives.data(), receivers.data(), u.data(), v.data(), many.data(),
              is_valid.data(), scratch);
  int valid = 0, deltas = 0;
  for (size_t i = 0; i < n; ++i) {
    LightSample alone;
    const LightPrimitive& p = lights[primitives[i]];
    REQUIRE(sample(s, p, receivers[i], {u[i], v[i]}, alone) == (is_valid[i] != 0));
    if (is_valid[i] == 0) continue;
    ++valid;
    deltas += alone.is_delta ? 1 : 0;
    CHECK(many[i].is_delta == alone.is_delta);
    CHECK(many[i].radiance == alone.radiance);
    CHECK(length(many[i].wi - alone.wi) < 1e-4f);
    CHECK(many[i].pdf_solid_angle == doctest::Approx(alone.pdf_solid_angle).epsilon(1e-3));
    if (p.has_surface()) {
      CHECK(alone.radiance ==
            emitted_radiance(s, s.lights[p.light], alone.is_front, alone.texture_uv, -alone.wi));
    }
  }
  CHECK(valid > 100);
  CHECK(deltas > 10);
}

TEST_CASE("certificate shapes: flat, spheres that shine outwards, none") {
  Scene s = one_of_each();
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  make_light(s, 0, Rgb{1});
  add_disk_light(s, grey, {}, {0, 0, 1}, 1, Rgb{1});
  add_sphere_light(s, grey, {}, 1, Rgb{1});
  add_sphere_light(s, grey, {}, 1, Rgb{1}, true);
  add_sphere_light(s, grey, {}, 1, Rgb{1}, false, true);
  using enum CertificateShape;
  const CertificateShape expected[] = {none, none, none, none, flat, flat, sphere, none, none};
  REQUIRE(s.lights.size() == std::size(expected));
  for (size_t i = 0; i < s.lights.size(); ++i)
    CHECK(certificate_shape(s, s.lights[i]) == expected[i]);
}

// Radiant intensity at angle a is (outer - a) / (outer - inner) between the two angles. Its
// integral over all directions is computed by the midpoint rule.
TEST_CASE("a spot that fades linearly in the angle, as in Mitsuba") {
  Scene s;
  add_spot(s, lamp, {0, 0, -1}, float(std::cos(rad_from_deg(15.0))),
           float(std::cos(rad_from_deg(40.0))), Rgb{1});
  Light& e = s.lights[0];
  e.falloff = SpotFalloff::linear;
  const auto share = [&](double degrees) {
    return double(SpotLight::share(e, float(std::cos(rad_from_deg(degrees)))));
  };
  CHECK(share(10) == 1);
  CHECK(share(20) == doctest::Approx(0.8).epsilon(1e-4));
  CHECK(share(27.5) == doctest::Approx(0.5).epsilon(1e-4));
  CHECK(share(41) == 0);
  constexpr int n = 20000;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double a = pi / 2 * (i + 0.5) / n;
    sum += double(SpotLight::share(e, float(std::cos(a)))) * std::sin(a) * 2 * pi * (pi / 2) / n;
  }
  CHECK(double(SpotLight::effective_solid_angle(e)) == doctest::Approx(sum).epsilon(1e-4));
}
