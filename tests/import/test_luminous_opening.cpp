// Tests of luminous openings: shapes by the signs of dimensions, and the size of bodies.
#include "import/luminaire/luminous_opening.h"

#include <doctest/doctest.h>

#include <cmath>

#include "base/units.h"

using namespace troffer;

namespace test_luminous_opening {

namespace {

using Shape = OpeningBody::Shape;

OpeningBody ies(double width, double length, double height, bool is_old = false) {
  return body_of(ies_opening(width, length, height, is_old));
}

// Returns the projected area of the faces that look towards w.
double seen_from(const OpeningBody& body, const Vec3d& w) {
  double sum = 0;
  for (const OpeningFace& f : body.faces) sum += std::max(0.0, dot(f.area, w));
  return sum;
}

}  // namespace

TEST_CASE("shapes follow from the signs of LM-63's dimensions") {
  CHECK(ies(0, 0, 0).shape == Shape::point);
  CHECK(ies(0, 1, 0).shape == Shape::point);
  CHECK(ies(.5, 1, 0).faces.size() == 1);
  CHECK(ies(.5, 1, .1).faces.size() == 6);
  CHECK(ies(-.4, -.4, 0).shape == Shape::disc);
  CHECK(ies(-.4, -.4, 0).radius == doctest::Approx(.2));
  CHECK(ies(-.4, 0, 0, true).shape == Shape::disc);
  CHECK(ies(0, -.4, 0, true).shape == Shape::disc);
  CHECK(ies(-.4, -.6, 0).faces.size() == 1);
  CHECK(ies(-.4, .6, 0, true).faces.size() == 1);
  CHECK(ies(-.4, -.4, 1).faces.size() == circle_corners + 2);
  CHECK(ies(-.4, 0, 1, true).faces.size() == circle_corners + 2);
  CHECK(ies(-.4, -.4, -.4).shape == Shape::sphere);
  CHECK(ies(-.4, -.4, -.4).radius == doctest::Approx(.2));
  CHECK(ies(-.4, 1, -.4).faces.size() == circle_corners + 2);
  CHECK(ies(1, -.4, -.4).faces.size() == circle_corners + 2);
  const OpeningBody facing = ies(-.4, 0, -.4);  // a vertical circle that faces C0
  REQUIRE(facing.faces.size() == 1);
  CHECK(facing.faces[0].area.x == doctest::Approx(.04 * pi));
}

TEST_CASE("shapes follow from the signs of dimensions in LM-63-1995") {
  const auto size_of = [](double width, double length, double height) {
    return ies_opening(width, length, height, true).size;
  };
  // Horizontal cylinders: the height is the diameter.
  CHECK(size_of(0, 1.2, -.04) == Vec3d{1.2, .04, .04});
  CHECK(size_of(1.2, 0, -.04) == Vec3d{.04, 1.2, .04});
  const Vec3d w = normalize(Vec3d{.3, -.5, .7});
  for (const OpeningBody& body : {ies(0, 1.2, -.04, true), ies(1.2, 0, -.04, true)})
    CHECK(body.faces.size() == circle_corners + 2);
  const double seen = .04 * 1.2 * std::sqrt(1 - w.x * w.x) + pi * .0004 * std::abs(w.x);
  CHECK(seen_from(ies(0, 1.2, -.04, true), w) == doctest::Approx(seen).epsilon(.01));
  // Ellipses and ellipsoids along length and width; a sphere by two signs.
  CHECK(ies(-.12, .34, .56, true).faces.size() == circle_corners + 2);
  CHECK(ies(.12, -.34, .56, true).faces.size() == circle_corners + 2);
  for (const OpeningBody& body : {ies(-.2, .4, -.1, true), ies(.4, -.2, -.1, true)}) {
    CHECK(body.shape == Shape::sphere);
    CHECK(body.radius == doctest::Approx(.1));
  }
  CHECK(ies(-.12, 0, -.12, true).shape == Shape::sphere);
  // A box without negative dimensions remains a box.
  CHECK(ies(.5, 1, .1, true).faces.size() == 6);
}

TEST_CASE("luminous bodies have their projected area from any side") {
  const Vec3d w = normalize(Vec3d{.3, -.5, .7});
  const double box = .6 * .2 * std::abs(w.x) + 1 * .2 * std::abs(w.y) + 1 * .6 * std::abs(w.z);
  CHECK(seen_from(ies(.6, 1, .2), w) == doctest::Approx(box));
  CHECK(seen_from(ies(.6, 1, .2), -w) == doctest::Approx(box));
  // d h sin + area of the cap × cos. Polygons with a circle's area are slightly wider in places.
  const double sine = std::sqrt(1 - w.z * w.z);
  const double upright = .4 * 1 * sine + pi * .04 * std::abs(w.z);
  CHECK(seen_from(ies(-.4, -.4, 1), w) == doctest::Approx(upright).epsilon(.01));
  const double lying = .4 * 1 * std::sqrt(1 - w.x * w.x) + pi * .04 * std::abs(w.x);
  CHECK(seen_from(ies(-.4, 1, -.4), w) == doctest::Approx(lying).epsilon(.01));
  for (const OpeningBody& body : {ies(.6, 1, .2), ies(-.4, -.4, 1), ies(1, -.4, -.4)}) {
    Vec3d sum;
    for (const OpeningFace& f : body.faces) {
      sum += f.area;
      Vec3d middle;
      for (const Vec3d& p : f.outline) middle += p / double(f.outline.size());
      CHECK(dot(middle, f.area) > 0);  // outwards
    }
    CHECK(length(sum) < 1e-12);  // closed
  }
}

TEST_CASE("EULUMDAT: circles, and boxes whose sides shine part of their height") {
  CHECK(body_of(eulumdat_opening(.5, 0, {})).shape == Shape::disc);
  CHECK(body_of(eulumdat_opening(.5, 0, {.1, .1, .1, .1})).faces.size() == circle_corners + 2);
  const OpeningBody box = body_of(eulumdat_opening(1.2, .3, {.1, 0, .05, 0}));
  REQUIRE(box.faces.size() == 4);
  CHECK(seen_from(box, {1, 0, 0}) == doctest::Approx(.12));
  CHECK(seen_from(box, {-1, 0, 0}) == doctest::Approx(.06));
  CHECK(seen_from(box, {0, 1, 0}) == doctest::Approx(0));
  CHECK(seen_from(box, {0, 0, 1}) == doctest::Approx(.36));
}

TEST_CASE("a face shines if more than a thousandth of the light leaves through it") {
  LightWeb web;
  web.vertical_angles_rad = {0, float(pi / 4), float(pi / 2), float(pi)};
  web.horizontal_angles_rad = {0, 2 * pi_f};
  web.intensities = {100, 50, .05f, 0, 100, 50, .05f, 0};
  CHECK(shines_towards(web, {0, 0, 1}));
  for (const double turn : {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0})
    CHECK(shines_towards(web, {std::cos(turn), std::sin(turn), 0}));
  CHECK_FALSE(shines_towards(web, {0, 0, -1}));
}

}  // namespace test_luminous_opening
