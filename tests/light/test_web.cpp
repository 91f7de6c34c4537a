// Measured distributions as the lights have them: directions by type of photometry, and lumens.
#include "light/web.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "base/units.h"
#include "import/luminaire.h"
#include "support/beam_ies.h"

using namespace troffer;
using namespace troffer::test;

namespace {

LightWeb read(const std::string& text) {
  WarningLog warnings;
  return read_luminaire_text("a.ies", text, warnings).web;
}

}  // namespace

TEST_CASE("types A and B: their angles from the beam, upwards and to the right") {
  const double v = rad_from_deg(30.0), h = rad_from_deg(45.0);
  // Upwards is C0 (x), right C270 (-y), seen from behind.
  const Vec3d of_a{std::sin(v), -std::cos(v) * std::sin(h), std::cos(v) * std::cos(h)};
  const Vec3d of_b{std::cos(h) * std::sin(v), -std::sin(h), std::cos(h) * std::cos(v)};
  for (const auto& [type, w] : {std::pair{3, of_a}, {2, of_b}}) {
    const LightWeb l = read(beam_ies(type, {-90, -30, 0, 30, 90}, {-90, -45, 0, 45, 90}));
    CAPTURE(type);
    CHECK(double(intensity(l, Vec3(w))) == doctest::Approx(1480));
    CHECK(double(intensity(l, Vec3(w * Vec3d{-1, -1, 1}))) == doctest::Approx(520));
    CHECK(double(intensity(l, {0, 0, 1})) == doctest::Approx(1000));
    CHECK(intensity(l, {0, 0, -1}) == 0);
    // Half of it, and what mirrors that.
    const LightWeb half = read(beam_ies(type, {-90, -30, 0, 30, 90}, {0, 45, 90}));
    CHECK(double(intensity(half, Vec3(w))) == doctest::Approx(1480));
    CHECK(double(intensity(half, Vec3(w * Vec3d{1, -1, 1}))) == doctest::Approx(1480));
    const LightWeb quarter = read(beam_ies(type, {0, 30, 90}, {0, 45, 90}));
    CHECK(double(intensity(quarter, Vec3(w * Vec3d{-1, -1, 1}))) == doctest::Approx(1480));
    const LightWeb round = read(beam_ies(type, {-90, -30, 0, 30, 90}, {0}));
    for (const double turn : {0.0, 1.0, 4.0})
      CHECK(double(intensity(round, Vec3(Vec3d{std::sin(v) * std::cos(turn),
                                               std::sin(v) * std::sin(turn), std::cos(v)}))) ==
            doctest::Approx(1000));
  }
}

TEST_CASE("lumens of all types are recovered within a thousandth") {
  // I = 1000 cos³ of the angle from the beam: 2 pi 1000 / 4 lm.
  for (const int type : {1, 2, 3}) {
    std::string text =
        "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 181 181 " + std::to_string(type) + " 2 0 0 0 1 1 10\n";
    std::vector<double> vertical, horizontal;
    for (int i = 0; i <= 180; ++i) {
      vertical.push_back(type == 1 ? i : i - 90);
      horizontal.push_back(type == 1 ? 2 * i : i - 90);
    }
    for (const auto* angles : {&vertical, &horizontal})
      for (const double a : *angles) text += std::to_string(a) + "\n";
    for (const double h : horizontal)
      for (const double v : vertical) {
        const double z = type == 1 ? std::cos(rad_from_deg(v))
                                   : std::cos(rad_from_deg(v)) * std::cos(rad_from_deg(h));
        text += std::to_string(1000 * std::pow(std::max(z, 0.0), 3)) + "\n";
      }
    CAPTURE(type);
    CHECK(flux(read(text)) == doctest::Approx(500 * pi).epsilon(1e-3));
  }
}

TEST_CASE("what leaves the faces of an opening adds up to the flux") {
  LightWeb web = read(beam_ies(2, {-90, -60, 0, 60, 90}, {-90, -45, 0, 45, 90}));
  web.faces = {{.12f, 0, 0}, {-.12f, 0, 0}, {0, .2f, 0}, {0, -.2f, 0}, {0, 0, .6f}, {0, 0, -.6f}};
  const WebSamples samples(web);
  double sum = 0;
  for (const Vec3& face : web.faces) {
    const float area = length(face);
    sum += double(area) * samples.exitance(face * (1 / area));
  }
  CHECK(sum == doctest::Approx(flux(web)).epsilon(2e-3));
  CHECK(samples.exitance({0, 0, -1}) == doctest::Approx(0));
}
