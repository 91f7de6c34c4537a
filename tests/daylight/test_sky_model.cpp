// Skies compared with quadrature in double precision and with published figures.
#include "daylight/sky_model.h"

#include <doctest/doctest.h>

#include <cmath>

#include "base/units.h"
#include "daylight/sky_lights.h"
#include "light/light.h"
#include "support/quadrature.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// Gauss-Legendre quadrature over zenith angle and azimuth from the sun. Integrates luminance times
// the cosine at a plane with unit normal n = (sin t, 0, cos t); the sun lies in the plane of x and
// z.
template <class F>
double illuminance(const F& luminance, double tilt) {
  static const GaussLegendre<double> rule(200);
  double sum = 0;
  for (size_t i = 0; i < rule.nodes.size(); ++i)
    for (size_t k = 0; k < rule.nodes.size(); ++k) {
      const double z = rule.nodes[i] * pi / 2, azimuth = rule.nodes[k] * pi;
      const double cosine =
          std::cos(tilt) * std::cos(z) + std::sin(tilt) * std::sin(z) * std::cos(azimuth);
      if (cosine > 0)
        sum += rule.weights[i] * rule.weights[k] * cosine * std::sin(z) * luminance(z, azimuth);
    }
  return sum * pi / 2 * pi * 2;
}

}  // namespace

TEST_CASE("the horizontal integral of every general sky agrees with quadrature") {
  for (int type = 1; type <= 15; ++type)
    for (const double sun_zenith_deg : {20.0, 60.0, 85.0}) {
      const SkyShape s = cie_sky(type);
      const double zs = rad_from_deg(sun_zenith_deg);
      // Derived from the standard, not from the code.
      const double full = illuminance(
          [&](double z, double azimuth) {
            const double x = std::acos(std::clamp(
                std::cos(z) * std::cos(zs) + std::sin(z) * std::sin(zs) * std::cos(azimuth), -1.0,
                1.0));
            const double gradation = 1 + double(s.a) * std::exp(double(s.b) / std::cos(z));
            const double indicatrix =
                1 + double(s.c) * (std::exp(double(s.d) * x) - std::exp(double(s.d) * pi / 2)) +
                double(s.e) * std::cos(x) * std::cos(x);
            return gradation * indicatrix;
          },
          0);
      CAPTURE(type);
      CAPTURE(sun_zenith_deg);
      CHECK(horizontal_integral(s, zs) == doctest::Approx(full).epsilon(5e-5));
    }
}

TEST_CASE(
    "clear skies by Linke turbidity agree with a calculation by hand from the published formulas") {
  // T = 3 at 60 degrees: air mass 1.1540, Rayleigh thickness .11774, exp(-.8662 T m d) = .7025
  const Irradiance high = clear_irradiance(3, 60, 1);
  CHECK(high.direct_normal == doctest::Approx(1367 * 0.7026).epsilon(1e-3));
  CHECK(high.diffuse_horizontal == doctest::Approx(1367 * 0.079203 * 1.00607).epsilon(1e-3));
  for (const double altitude : {0.5, 5.0, 30.0, 90.0})
    for (double t = 1; t < 10; t += 0.5) {
      const Irradiance less = clear_irradiance(t, altitude, 1),
                       more = clear_irradiance(t + 0.5, altitude, 1);
      CHECK(more.direct_normal < less.direct_normal);
      CHECK(less.diffuse_horizontal >= 0);
      CHECK(less.direct_normal < 1367);
    }
  CHECK(clear_irradiance(5, 40, 1).diffuse_horizontal >
        clear_irradiance(2, 40, 1).diffuse_horizontal);
}

TEST_CASE("skies have the properties that the standard states") {
  // Type 5 is uniform: pi. Type 1, overcast: the zenith is about three times as bright as the
  // horizon.
  CHECK(horizontal_integral(cie_sky(5), 0.3) == doctest::Approx(pi).epsilon(1e-5));
  const SkyShape overcast = cie_sky(1);
  const double zenith = 1 + 4 * std::exp(-0.7);
  CHECK(zenith == doctest::Approx(2.986).epsilon(1e-3));
  CHECK(double(overcast.a) == 4);
  // The traditional overcast sky has zenith over diffuse horizontal 3 / (7 pi / 3); within 2 %.
  CHECK(zenith / horizontal_integral(overcast, 0) == doctest::Approx(9 / (7 * pi)).epsilon(0.02));
}

TEST_CASE("a sky gives the requested illuminance, and on all sides that of quadrature") {
  for (int type = 1; type <= 15; ++type) {
    Scene scene;
    scene.is_photometric = true;
    SkyRequest request;
    request.kind = SkyKind::cie;
    request.cie_type = type;
    request.diffuse_lx = 12345;
    request.ground_reflectance = 0;
    request.sun = SunRequest{90, 35, 1, 0.0};  // in the east
    add_sky(scene, request, make_compass({0, 0, 1}, 0, false));
    REQUIRE(scene.lights.size() == 1);
    const LightPrimitives lights(scene);
    const auto seen = [&](double z, double azimuth) {
      const Vec3 w(
          Vec3d{std::sin(z) * std::cos(azimuth), std::sin(z) * std::sin(azimuth), std::cos(z)});
      return double(radiance_at_infinity(scene, lights[0], {}, w).g);
    };
    CAPTURE(type);
    CHECK(illuminance(seen, 0) == doctest::Approx(12345).epsilon(1e-4));
    // The side facing the sun is at least as bright.
    const SkyShape s = cie_sky(type);
    const double zs = rad_from_deg(55.0);
    for (const double tilt : {pi / 2, -pi / 2}) {
      const double expected = 12345 / horizontal_integral(s, zs) *
                              illuminance(
                                  [&](double z, double azimuth) {
                                    const double c = std::cos(z) * std::cos(zs) +
                                                     std::sin(z) * std::sin(zs) * std::cos(azimuth);
                                    const double x = std::acos(std::clamp(c, -1.0, 1.0));
                                    return (1 + double(s.a) * std::exp(double(s.b) / std::cos(z))) *
                                           (double(s.k) + double(s.c) * std::exp(double(s.d) * x) +
                                            double(s.e) * c * c);
                                  },
                                  tilt);
      CHECK(illuminance(seen, tilt) == doctest::Approx(expected).epsilon(1e-4));
    }
  }
}

TEST_CASE("a sun and a ground add up") {
  Scene scene;
  SkyRequest request;
  request.kind = SkyKind::cie;
  request.cie_type = 12;
  request.diffuse_lx = 10'000;
  request.sun = SunRequest{200, 30, 1, 80'000.0};
  request.ground_reflectance = 0.25;
  add_sky(scene, request, make_compass({0, 1, 0}, 0, false));
  REQUIRE(scene.lights.size() == 2);
  const Light& sun = scene.lights[1];
  const double s = std::sin(double(sun.angular_radius));
  CHECK(double(sun.radiance.g) * pi * s * s * luminous_efficacy ==
        doctest::Approx(80'000).epsilon(1e-4));
  CHECK(double(scene.lights[0].sky.ground.g) * luminous_efficacy ==
        doctest::Approx(0.25 * (10'000 + 80'000 * 0.5) / pi).epsilon(1e-4));
  // Azimuth 200 is south-south-west; north is -z and east is +x.
  const Vec3 to_sun = -sun.direction;
  CHECK(double(to_sun.y) == doctest::Approx(0.5).epsilon(1e-5));
  CHECK(double(to_sun.x) == doctest::Approx(std::cos(pi / 6) * std::sin(rad_from_deg(200.0))));
  CHECK(double(to_sun.z) == doctest::Approx(-std::cos(pi / 6) * std::cos(rad_from_deg(200.0))));
}

TEST_CASE("north is where it is set, east to its right, mirrored in mirrored worlds") {
  const Compass z = make_compass({0, 0, 2}, 0, false);
  CHECK(length(z.north - Vec3d{0, 1, 0}) < 1e-12);
  CHECK(length(z.east - Vec3d{1, 0, 0}) < 1e-12);
  CHECK(length(make_compass({0, 0, 2}, 0, true).east - Vec3d{-1, 0, 0}) < 1e-12);
  const Compass y = make_compass({0, 1, 0}, 90, false);
  CHECK(length(y.north - Vec3d{1, 0, 0}) < 1e-12);
  CHECK(length(y.east - Vec3d{0, 0, 1}) < 1e-12);
}

TEST_CASE("Perez skies: overcast ones brighten upwards, clear ones towards the sun") {
  const double zs = rad_from_deg(50.0);
  const PerezSky overcast = perez_sky(0, 150, zs, 1), clear = perez_sky(850, 90, zs, 1);
  const auto lum = [](const SkyShape& s, double z, double azimuth, double sun) {
    const double c = std::cos(z) * std::cos(sun) + std::sin(z) * std::sin(sun) * std::cos(azimuth);
    return (1 + double(s.a) * std::exp(double(s.b) / std::cos(z))) *
           (double(s.k) + double(s.c) * std::exp(double(s.d) * std::acos(c)) + double(s.e) * c * c);
  };
  CHECK(lum(overcast.shape, 0, 0, zs) > 1.3 * lum(overcast.shape, 1.4, 2, zs));
  CHECK(lum(clear.shape, zs + 0.1, 0, zs) > 3 * lum(clear.shape, zs, pi, zs));
  // Measured efficacies: about 110 to 150 lm/W for the sky, 90 to 110 for the sun.
  CHECK(overcast.diffuse_lx / 150 > 105);
  CHECK(overcast.diffuse_lx / 150 < 125);
  CHECK(clear.diffuse_lx / 90 > 115);
  CHECK(clear.diffuse_lx / 90 < 150);
  CHECK(clear.direct_lx / 850 > 90);
  CHECK(clear.direct_lx / 850 < 110);
  CHECK(overcast.direct_lx == 0);
  // Any valid input gives a finite sky that is bright somewhere.
  for (const double direct : {0.0, 1.0, 30.0, 200.0, 900.0, 2000.0})
    for (const double diffuse : {1e-3, 5.0, 60.0, 300.0, 2000.0})
      for (const double z : {0.0, 0.7, 1.3, 1.56}) {
        const PerezSky sky = perez_sky(direct, diffuse, z, 1);
        const double sum = horizontal_integral(sky.shape, z);
        CHECK(std::isfinite(sum));
        CHECK(sum > 0);
        CHECK(sky.diffuse_lx > 0);
      }
}
