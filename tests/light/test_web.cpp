// Photometric webs as lights use them: directions for each type of photometry, and flux in lumens.
#include "light/web.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/random.h"
#include "base/units.h"
#include "import/luminaire/luminaire.h"
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
  // Seen from behind the beam, up is C0 (x) and right is C270 (-y).
  const Vec3d of_a{std::sin(v), -std::cos(v) * std::sin(h), std::cos(v) * std::cos(h)};
  const Vec3d of_b{std::cos(h) * std::sin(v), -std::sin(h), std::cos(h) * std::cos(v)};
  for (const auto& [type, w] : {std::pair{3, of_a}, {2, of_b}}) {
    const LightWeb l = read(beam_ies(type, {-90, -30, 0, 30, 90}, {-90, -45, 0, 45, 90}));
    CAPTURE(type);
    CHECK(double(intensity(l, Vec3(w))) == doctest::Approx(1480));
    CHECK(double(intensity(l, Vec3(w * Vec3d{-1, -1, 1}))) == doctest::Approx(520));
    CHECK(double(intensity(l, {0, 0, 1})) == doctest::Approx(1000));
    CHECK(intensity(l, {0, 0, -1}) == 0);
    // Files with half of the planes: the other half mirrors them.
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

TEST_CASE("lumens of files of all types are recovered within a thousandth") {
  // I = 1000 cos³ of the angle from the beam gives 2 pi 1000 / 4 lm.
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

TEST_CASE("light from the faces of an opening adds up to the flux") {
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

namespace {

// Ascending angles, some steps ten thousand times as wide as others.
std::vector<float> uneven_angles(Random& random, float from, float to, size_t n) {
  std::vector<float> steps(n), angles{from};
  float all = 0;
  for (float& s : steps) all += s = std::pow(10.0f, -4 * random.next_float());
  for (const float s : steps) angles.push_back(angles.back() + (to - from) * s / all);
  angles.back() = to;
  angles.erase(std::unique(angles.begin(), angles.end()), angles.end());
  return angles;
}

}  // namespace

TEST_CASE("a web evaluated for many points at once equals single evaluations") {
  Random random(7);
  for (int trial = 0; trial < 30; ++trial) {
    LightWeb web;
    web.pole = WebPole(trial % 3);
    // The full range, or a part without the pole, the equator and half of the turns.
    const bool is_whole = trial % 2 == 0;
    const size_t wanted = trial < 3 ? 1 : trial < 10 ? 20 : 700;
    web.vertical_angles_rad =
        uneven_angles(random, is_whole ? 0 : .3f, is_whole ? pi_f : 1.4f, wanted);
    web.horizontal_angles_rad =
        uneven_angles(random, is_whole ? -pi_f : .2f, is_whole ? pi_f : 4.2f, wanted);
    // Smooth, so that rounding of angles has no visible effect.
    const size_t n = web.vertical_angles_rad.size();
    for (size_t i = 0; i < web.horizontal_angles_rad.size(); ++i)
      for (size_t j = 0; j < n; ++j)
        web.intensities.push_back(500 + 400 * std::cos(3 * web.horizontal_angles_rad[i]) *
                                            std::sin(2 * web.vertical_angles_rad[j]));
    web.faces = {{.1f, 0, 0}, {0, 0, .4f}};
    std::vector<float> x, y, z;
    std::vector<Vec3> directions;
    while (x.size() < 1000) {
      const Vec3 d{random.next_float() - .5f, random.next_float() - .5f, random.next_float() - .5f};
      if (length(d) < .01f) continue;
      directions.push_back(normalize(d));
      x.push_back(-3 * d.x), y.push_back(-3 * d.y), z.push_back(-3 * d.z);
    }
    std::vector<float> found(x.size());
    WebLanes lanes;
    WebLookup(web).radiance_many({Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}, x.size(), x.data(),
                                 y.data(), z.data(), lanes, found.data());
    CAPTURE(trial);
    int dark = 0;
    for (size_t i = 0; i < x.size(); ++i) {
      const float right = radiance(web, directions[i]);
      dark += right == 0;
      CHECK(double(found[i]) == doctest::Approx(double(right)).epsilon(2e-5));
    }
    CHECK((dark > 0) == !is_whole);
  }
}

TEST_CASE("a web is dark at points without a direction") {
  const LightWeb web = read(beam_ies(2, {-90, -60, 0, 60, 90}, {-90, -45, 0, 45, 90}));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> x{nan, 1e30f, 0}, y{nan, 1e30f, 0}, z{nan, 1e30f, -1};
  std::vector<float> found(x.size());
  WebLanes lanes;
  WebLookup(web).radiance_many({Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}, x.size(), x.data(),
                               y.data(), z.data(), lanes, found.data());
  CHECK(found[0] == 0);
  CHECK(found[1] == 0);
  CHECK(found[2] > 0);
}
