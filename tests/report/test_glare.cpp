// UGR compared with hand calculations, and Guth's index with the table of CIE 117.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "base/units.h"
#include "light/irradiance.h"
#include "report/glare.h"
#include "support/scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace test_glare {

namespace {

constexpr Vec3d up{0, 0, 1};

double index_at(double beside, double above) {  // relative to the distance ahead
  return position_index({1, beside, above}, {1, 0, 0}, up);
}

// A source of .6 × .6 m that faces the eye at (0,0,1.2), 3 m ahead and 1 m above it.
Scene panel_ahead(Rgb radiance, float side = 0.6f) {
  Scene s;
  s.is_photometric = true;
  const uint32_t black = add_diffuse(s, Rgb{0});
  const Vec3 c{3, 0, 2.2f}, n = normalize(Vec3{-3, 0, -1}), a{0, side / 2, 0};
  const Vec3 b = cross(n, Vec3{0, 1, 0}) * (side / 2);
  make_light(s, add_quad(s, black, {c - a - b, c + a - b, c + a + b, c - a + b}), radiance);
  s.lights.back().name = "panel";
  return s;
}

const Observer ahead{{0, 0, 1.2}, {1, 0, 0}};

}  // namespace

TEST_CASE("the position index is that of CIE 117's table") {
  struct Row {
    double beside, above, index;
  };
  // T/R, H/R and p of the table; the formula fits it within a few percent.
  for (const Row& r :
       {Row{0, 0, 1}, {0, 0.5, 2.86}, {0, 1, 7}, {0, 1.5, 13.15}, {0.5, 0, 1.43}, {1, 0, 2.11}}) {
    CAPTURE(r.beside);
    CAPTURE(r.above);
    CHECK(index_at(r.beside, r.above) == doctest::Approx(r.index).epsilon(0.035));
    CHECK(index_at(-r.beside, r.above) == index_at(r.beside, r.above));
  }
  CHECK(index_at(0, 0) == 1);
}

TEST_CASE(
    "the position index below the line of sight is that of Iwata and Tokura; beyond the table "
    "nothing counts") {
  CHECK(index_at(0, -0.5) == doctest::Approx(1.4));
  CHECK(index_at(0, -1) == doctest::Approx(2.2));
  CHECK(index_at(0.3, -0.4) == doctest::Approx(1.4));
  constexpr double outside = std::numeric_limits<double>::infinity();
  CHECK(index_at(0, 1.91) == outside);
  CHECK(index_at(3.01, 0.1) == outside);
  CHECK(position_index({-1, 0, 0}, {1, 0, 0}, up) == outside);
  CHECK(index_at(0, 1.89) < 30);
}

TEST_CASE("the UGR of one panel agrees with 8 log10(.25 / Lb L² ω / p²)") {
  const PreparedScene scene(panel_ahead(Rgb{5000}));
  const auto seen = seen_luminaires(scene, ahead, up, 0);
  REQUIRE(seen.size() == 1);
  // A square that faces the eye at distance r: ω = 4 asin(a² / (r² + a²)), with a half its side.
  const double r = std::sqrt(10.0), a = 0.3;
  const double solid_angle = 4 * std::asin(a * a / (r * r + a * a));
  CHECK(seen[0].solid_angle == doctest::Approx(solid_angle).epsilon(1e-3));
  CHECK(seen[0].luminance == doctest::Approx(5000).epsilon(1e-3));
  // In the vertical plane τ = 0: ln p = 33.98e-3 σ + 21e-5 σ² at σ = atan(1/3) = 18.435°.
  const double sigma = deg_from_rad(std::atan(1.0 / 3));
  const double p = std::exp(33.98e-3 * sigma + 21e-5 * sigma * sigma);
  CHECK(seen[0].position_index == doctest::Approx(p).epsilon(2e-3));
  const Glare g = glare_of(ahead, {40 * pi, 0.4 * pi}, seen);
  const double ugr = 8 * std::log10(0.25 / 40 * 5000 * 5000 * solid_angle / (p * p));
  CHECK(g.is_defined);
  CHECK(g.background.value == doctest::Approx(40));
  CHECK(std::abs(g.ugr.value - ugr) < 0.05);
  CHECK(g.ugr.error == doctest::Approx(8 / std::log(10.0) * 0.01).epsilon(0.2));
  CHECK_FALSE(g.is_large);
  CHECK_FALSE(seen[0].is_small);
}

TEST_CASE(
    "an object that hides half of a panel halves its term; a panel behind the eye does not glare") {
  Scene s = panel_ahead(Rgb{5000});
  const uint32_t black = add_diffuse(s, Rgb{0});
  add_quad(s, black, {Vec3{1.5f, 0, 0}, {1.5f, 9, 0}, {1.5f, 9, 4}, {1.5f, 0, 4}});
  const PreparedScene half(std::move(s)), open(panel_ahead(Rgb{5000}));
  const auto seen = seen_luminaires(half, ahead, up, 1), all = seen_luminaires(open, ahead, up, 1);
  REQUIRE(seen.size() == 1);
  CHECK(seen[0].term.value / all[0].term.value == doctest::Approx(0.5).epsilon(0.05));
  CHECK(seen_luminaires(open, {{0, 0, 1.2}, {-1, 0, 0}}, up, 1).empty());
  CHECK_FALSE(glare_of(ahead, {100, 1}, {}).is_defined);
  CHECK_FALSE(glare_of(ahead, {0, 0}, all).is_defined);
}

TEST_CASE("a small luminaire and a point have the glare term 200 I² / (r² p²)") {
  const double r2 = 10, side = 0.02, sigma = deg_from_rad(std::atan(1.0 / 3));
  const double p = std::exp(33.98e-3 * sigma + 21e-5 * sigma * sigma);
  const double candela = 1e6 * side * side;
  const PreparedScene tiny(panel_ahead(Rgb{1e6f}, float(side)));
  const auto seen = seen_luminaires(tiny, ahead, up, 2);
  REQUIRE(seen.size() == 1);
  CHECK(seen[0].is_small);
  CHECK(seen[0].term.value ==
        doctest::Approx(200 * candela * candela / (r2 * p * p)).epsilon(2e-3));
  Scene s;
  s.is_photometric = true;
  Light e;
  e.kind = LightKind::point;
  e.name = "bulb";
  e.position = {3, 0, 2.2f};
  e.radiance = Rgb{float(candela)};
  s.lights.push_back(e);
  const uint32_t black = add_diffuse(s, Rgb{0});
  add_quad(s, black, {Vec3{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}});
  const PreparedScene point(std::move(s));
  const auto bulb = seen_luminaires(point, ahead, up, 2);
  REQUIRE(bulb.size() == 1);
  CHECK(bulb[0].term.value ==
        doctest::Approx(200 * candela * candela / (r2 * p * p)).epsilon(1e-4));
}

TEST_CASE("separate lamps of one name are separate luminaires") {
  Scene s;
  s.is_photometric = true;
  const uint32_t black = add_diffuse(s, Rgb{0});
  for (const float y : {-1.0f, 1.0f}) {
    make_light(
        s,
        add_quad(
            s, black,
            {Vec3{4, y - 0.1f, 1.8f}, {4, y - 0.1f, 2}, {4, y + 0.1f, 2}, {4, y + 0.1f, 1.8f}}),
        Rgb{5000});
    s.lights.back().name = "pair";
  }
  const PreparedScene scene(std::move(s));
  const auto seen = seen_luminaires(scene, ahead, up, 4);
  REQUIRE(seen.size() == 2);
  for (const SeenLuminaire& l : seen)
    CHECK(l.position_index == doctest::Approx(index_at(0.25, 0.175)).epsilon(0.01));
}

TEST_CASE("a luminaire of two faces counts by its mean luminance") {
  // Two adjacent halves with one name: 2000 and 8000 cd/m².
  Scene s;
  s.is_photometric = true;
  const uint32_t black = add_diffuse(s, Rgb{0});
  for (const float side : {-1.0f, 1.0f}) {
    const float y0 = side < 0 ? -0.2f : 0, y1 = side < 0 ? 0 : 0.2f;
    make_light(s, add_quad(s, black, {Vec3{4, y0, 1}, {4, y0, 1.4f}, {4, y1, 1.4f}, {4, y1, 1}}),
               Rgb{side < 0 ? 2000.0f : 8000.0f});
    s.lights.back().name = "pair";
  }
  const PreparedScene scene(std::move(s));
  const auto seen = seen_luminaires(scene, ahead, up, 4);
  REQUIRE(seen.size() == 1);
  CHECK(seen[0].luminance == doctest::Approx(5000).epsilon(0.01));
  CHECK(seen[0].term.value ==
        doctest::Approx(25e6 * seen[0].solid_angle / std::pow(seen[0].position_index, 2))
            .epsilon(0.01));
}

}  // namespace test_glare
