// Daylight glare of luminance pictures with closed forms: discs on even surroundings.
#include "report/daylight_glare.h"

#include <doctest/doctest.h>

#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "report/glare.h"
#include "report/glare_regions.h"

using namespace troffer;

namespace {

constexpr int side = 900;

// A disc of half angle `radius_deg`, `right_deg` beside and `up_deg` above the line of sight.
struct Disc {
  double right_deg, up_deg, radius_deg, luminance;

  Vec3d middle() const {
    const double a = rad_from_deg(right_deg), h = rad_from_deg(up_deg);
    return {std::sin(a) * std::cos(h), std::sin(h), std::cos(a) * std::cos(h)};
  }
  double solid_angle() const { return 2 * pi * (1 - std::cos(rad_from_deg(radius_deg))); }
  // ∫ cos dω over the disc: π sin²ρ times the cosine of its middle.
  double projected() const {
    const double s = std::sin(rad_from_deg(radius_deg));
    return pi * s * s * middle().z;
  }
};

Image picture_of(double background, const std::vector<Disc>& discs) {
  Image image(side, side);
  const FisheyeGrid grid{side};
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      double l = background;
      for (const Disc& d : discs)
        if (dot(grid.direction(x, y), d.middle()) > std::cos(rad_from_deg(d.radius_deg)))
          l = d.luminance;
      image.at(x, y) = Rgb{float(l)};
    }
  return image;
}

double dgp(double ev, double strength) {
  return 5.87e-5 * ev + 0.092 * std::log10(1 + strength / std::pow(ev, 1.87)) + 0.159;
}

}  // namespace

TEST_CASE("even surroundings have no source, and the DGP of their illuminance") {
  const DaylightGlare g = daylight_glare(picture_of(1000, {}), {});
  CHECK(g.vertical_lx == doctest::Approx(1000 * pi).epsilon(1e-3));
  CHECK(g.mean_luminance == doctest::Approx(1000));
  CHECK(g.sources.empty());
  CHECK(g.dgp == doctest::Approx(5.87e-5 * 1000 * pi + 0.159).epsilon(1e-3));
  CHECK(g.dgi == 0);
  CHECK(g.background_luminance == doctest::Approx(1000).epsilon(1e-3));
}

// [Wienold's low-light correction] e / (1 + e), e = exp(.024 Ev - 4).
TEST_CASE("in low light the DGP falls") {
  const Image dim = picture_of(50, {});
  const double ev = 50 * pi, e = std::exp(0.024 * ev - 4);
  CHECK(daylight_glare(dim, {}).dgp ==
        doctest::Approx((5.87e-5 * ev + 0.159) * e / (1 + e)).epsilon(2e-3));
  GlareSettings plain;
  plain.corrects_low_light = false;
  CHECK(daylight_glare(dim, plain).dgp == doctest::Approx(5.87e-5 * ev + 0.159).epsilon(1e-3));
}

// Guth's index 30° above: exp((35.2 - 1.22) 1e-3 30 + 21e-5 30²); 30° beside, tau = 90:
// a = 35.2 - .31889 90, b = 21 + .26667 90 - .002963 90². Below: 1 + .8 tan 30°, Iwata.
TEST_CASE("a bright disc is one source with its luminance, solid angle and position index") {
  const double guth_above = std::exp(33.98e-3 * 30 + 21e-5 * 900);
  const double guth_beside = std::exp((35.2 - 0.31889 * 90) * 1e-3 * 30 +
                                      (21 + 0.26667 * 90 - 0.002963 * 8100) * 1e-5 * 900);
  const double iwata_below = 1 + 0.8 * std::tan(rad_from_deg(30.0));
  const struct {
    Disc disc;
    double index;
  } cases[] = {{{0, 30, 5, 20000}, guth_above},
               {{30, 0, 5, 20000}, guth_beside},
               {{-30, 0, 5, 20000}, guth_beside},
               {{0, -30, 5, 20000}, iwata_below}};
  for (const auto& [disc, index] : cases) {
    const DaylightGlare g = daylight_glare(picture_of(500, {disc}), {});
    REQUIRE(g.sources.size() == 1);
    const DaylightGlareSource& s = g.sources[0];
    CHECK(s.luminance == doctest::Approx(20000));
    CHECK(s.solid_angle == doctest::Approx(disc.solid_angle()).epsilon(0.01));
    CHECK(length(s.direction - disc.middle()) < 0.005);
    CHECK(s.position_index == doctest::Approx(index).epsilon(0.01));
    CHECK(s.illuminance == doctest::Approx(20000 * disc.projected()).epsilon(0.01));
    const double ev = 500 * pi + 19500 * disc.projected();
    CHECK(g.vertical_lx == doctest::Approx(ev).epsilon(0.003));
    const double strength = 20000.0 * 20000 * disc.solid_angle() / (index * index);
    CHECK(g.dgp == doctest::Approx(dgp(ev, strength)).epsilon(0.003));
    const double background = (ev - 20000 * disc.projected()) / pi;
    CHECK(g.ugr == doctest::Approx(8 * std::log10(0.25 / background * strength)).epsilon(0.003));
    const double omega = disc.solid_angle();
    CHECK(g.dgi == doctest::Approx(10 * std::log10(0.478 * std::pow(20000, 1.6) *
                                                   std::pow(omega / (index * index), 0.8) /
                                                   (background + 0.07 * std::sqrt(omega) * 20000)))
                       .epsilon(0.003));
  }
}

// Half of the search radius of .2 rad is 5.7°.
TEST_CASE("sources up to half of the search radius apart are one") {
  const auto count = [](double gap_deg, double search) {
    const double apart = 4 + gap_deg;
    GlareSettings s;
    s.search_rad = search;
    return daylight_glare(picture_of(100, {{-apart / 2, 20, 2, 5000}, {apart / 2, 20, 2, 5000}}), s)
        .sources.size();
  };
  // The discs lie 20° up, where a step to the side is cos 20° as wide: 5.2 / cos 20° is 5.5°.
  CHECK(count(5.2, 0.2) == 1);
  CHECK(count(7.2, 0.2) == 2);
  CHECK(count(7.2, 0.4) == 1);
}

TEST_CASE("very bright parts of a source count apart") {
  const Disc window{10, 20, 8, 10000}, sun{10, 20, 1, 1e6};
  GlareSettings settings;
  const DaylightGlare g = daylight_glare(picture_of(300, {window, sun}), settings);
  REQUIRE(g.sources.size() == 2);
  CHECK(g.sources[0].luminance == doctest::Approx(1e6));
  CHECK(g.sources[0].solid_angle == doctest::Approx(sun.solid_angle()).epsilon(0.05));
  CHECK(g.sources[1].luminance == doctest::Approx(10000));
  CHECK(g.sources[1].solid_angle ==
        doctest::Approx(window.solid_angle() - sun.solid_angle()).epsilon(0.01));
  settings.peak = 0;
  CHECK(daylight_glare(picture_of(300, {window, sun}), settings).sources.size() == 1);
}

TEST_CASE("a threshold of up to 100 is a factor on the mean, or on the task") {
  // Mean: (2π 100 + ω (4000 - 100)) / 2π.
  const Disc lamp{0, 40, 6, 4000};
  GlareSettings s;
  s.threshold = 5;
  const DaylightGlare g = daylight_glare(picture_of(100, {lamp}), s);
  const double mean = 100 + lamp.solid_angle() * 3900 / (2 * pi);
  CHECK(g.threshold == doctest::Approx(5 * mean).epsilon(0.01));
  CHECK(g.sources.size() == 1);
  // A task in the lamp itself: its mean is 4000.
  s.task = Vec2{float(side) / 2, float(side) / 2 - float(side) * 40 / 180};
  s.task_rad = 0.1;
  const DaylightGlare bright = daylight_glare(picture_of(100, {lamp}), s);
  CHECK(bright.threshold == doctest::Approx(20000).epsilon(0.01));
  CHECK(bright.sources.empty());
  s.task = Vec2{1, 1};
  CHECK_THROWS_AS(daylight_glare(picture_of(100, {}), s), UsageError);
  CHECK_THROWS_AS(daylight_glare(Image(100, 50), GlareSettings()), UsageError);
}

TEST_CASE("position indices have evalglare's limits") {
  CHECK(wide_position_index({0, 0, 1}) == doctest::Approx(1).epsilon(1e-3));
  CHECK(wide_position_index({0, 1, 0.01}) == 16);
  // Below, the distance from the axis counts up to 3: 1 + 1.2 × 3.
  CHECK(wide_position_index({0, -1, 0.01}) == doctest::Approx(4.6));
  // evalglare 2021 gives 2.616 for a direction of its picture test, with tangents of angles.
  CHECK(wide_position_index({0.700947, -0.677534, 0.222758}) ==
        doctest::Approx(2.616443).epsilon(1e-4));
  // Equal to the bounded index where that is defined.
  for (const Vec3d w : {Vec3d{0.5, 0.3, 1}, Vec3d{0, -0.4, 1}, Vec3d{0.1, 1.2, 1}})
    CHECK(wide_position_index(w) ==
          doctest::Approx(position_index(w, {0, 0, 1}, {0, 1, 0})).epsilon(1e-9));
}
