// Sky patches against closed forms and against the matrix of Radiance's gendaymtx.
#include "daylight/reinhart_sky.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <vector>

#include "base/sun_position.h"
#include "base/units.h"
#include "daylight/sky_model.h"

using namespace troffer;

TEST_CASE("patches tile the hemisphere") {
  for (const int m : {1, 2, 4}) {
    const ReinhartSky sky(m);
    CHECK(sky.size() == size_t(144 * m * m + 1));
    double solid_angle = 0, cosine = 0;
    for (const ReinhartPatch& p : sky.patches()) {
      solid_angle += p.solid_angle;
      cosine += p.cosine;
    }
    CHECK(solid_angle == doctest::Approx(2 * pi).epsilon(1e-12));
    CHECK(cosine == doctest::Approx(pi).epsilon(1e-12));
  }
}

TEST_CASE("every patch holds the directions that it gives") {
  const ReinhartSky sky(2);
  for (size_t i = 0; i < sky.size(); ++i)
    for (const double u : {0.01, 0.5, 0.99})
      for (const double v : {0.01, 0.5, 0.99}) CHECK(sky.at(sky.patches()[i].direction(u, v)) == i);
}

TEST_CASE("patches give a horizontal plane the illuminance of the sky") {
  const PerezSky perez = perez_sky(600, 120, rad_from_deg(40), 1);
  const Vec3d to_sun{0, -std::sin(rad_from_deg(40)), std::cos(rad_from_deg(40))};
  const ReinhartSky sky(1);
  std::vector<float> luminance(sky.size());
  patch_luminances(sky, perez.shape, to_sun, perez.diffuse_lx, 4, luminance);
  double lx = 0;
  for (size_t i = 0; i < sky.size(); ++i) lx += double(luminance[i]) * sky.patches()[i].cosine;
  CHECK(lx == doctest::Approx(perez.diffuse_lx).epsilon(1e-5));
}

// gendaymtx -r 90 -m 1 -g .3 .2 .1 -c .9 .9 1.2 on test/gen/test.wea of Radiance. Values are red
// components of test/gen/ref/test.smx (three digits), W/(m² sr): ground, then some patches away
// from those four over which gendaymtx spreads the sun. Its sun position is a simpler formula, so
// patches close to the sun differ by a per cent or two.
TEST_CASE("Perez skies equal the matrix of gendaymtx") {
  struct Hour {
    int month;
    double hour, direct, diffuse, ground;
    std::array<double, 10> patches;
  };
  constexpr std::array<size_t, 10> which{1, 10, 20, 31, 45, 61, 75, 120, 140, 145};
  const std::array hours{
      Hour{3, 13.5, 40, 305, 20.2, {32.2, 71.7, 32.9, 32.6, 59.5, 31.8, 38.1, 37.5, 55.7, 48.0}},
      Hour{6, 10.5, 836, 212, 54.5, {56.4, 44.0, 43.2, 44.5, 25.5, 46.8, 19.0, 18.1, 78.2, 49.6}},
      Hour{12, 10.5, 688, 117, 23.6, {37.9, 60.1, 34.9, 28.7, 21.1, 23.3, 16.4, 11.7, 16.8, 13.1}}};
  const ReinhartSky sky(1);
  for (const Hour& h : hours) {
    CAPTURE(h.month);
    const SunPosition sun = sun_position(37.42, -122.05, julian_day(2015, h.month, 21, h.hour + 8));
    const double zenith = rad_from_deg(90 - sun.altitude_deg);
    const PerezSky perez = perez_sky(h.direct, h.diffuse, zenith, sun.distance_au);
    const double azimuth = rad_from_deg(sun.azimuth_deg - 90);  // -r 90
    const Vec3d to_sun{std::sin(zenith) * std::sin(azimuth), std::sin(zenith) * std::cos(azimuth),
                       std::cos(zenith)};
    std::vector<float> luminance(sky.size());
    patch_luminances(sky, perez.shape, to_sun, perez.diffuse_lx, 1, luminance);
    const double global = perez.diffuse_lx + perez.direct_lx * to_sun.z;
    CHECK(0.3 * global / pi / luminous_efficacy == doctest::Approx(h.ground).epsilon(0.01));
    for (size_t i = 0; i < which.size(); ++i) {
      CAPTURE(which[i]);
      const double radiance = 0.9 * double(luminance[which[i] - 1]) / luminous_efficacy;
      CHECK(radiance == doctest::Approx(h.patches[i]).epsilon(0.02));
    }
  }
}
