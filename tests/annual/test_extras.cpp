// Glare at eyes against closed forms and pictures, exposure to sunlight against the length of the
// day, and dimming against hours counted by hand.
#include <doctest/doctest.h>

#include <cmath>

#include "annual/annual.h"
#include "annual/electric.h"
#include "annual/eye_glare.h"
#include "annual/sunlight.h"
#include "base/error.h"
#include "base/units.h"
#include "daylight/sky_model.h"
#include "render/camera.h"
#include "render/render.h"
#include "report/daylight_glare.h"
#include "support/scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

const StopFlag goes_on = false;
constexpr double site_latitude = 48;

Compass north_is_y() {
  return make_compass({0, 0, 1}, 0, false);
}

WeatherYear march_day(double direct_normal) {
  WeatherYear year;
  year.latitude_deg = site_latitude;
  for (double hour = 7.5; hour < 18; hour += 2) {
    WeatherStep& s = year.steps.emplace_back();
    s.month = 3;
    s.day = 21;
    s.hour = hour;
    s.hour_of_year = 79 * 24 + hour;
    s.sun = sun_position(site_latitude, 0, julian_day(2015, 3, 21, hour));
    s.direct_normal = direct_normal;
    s.diffuse_horizontal = 250;
  }
  return year;
}

// A floor far below: the eye is in the open.
Scene open_air() {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.2f});
  add_quad(s, grey, {Vec3{-1, -1, -50}, {1, -1, -50}, {1, 1, -50}, {-1, 1, -50}});
  return s;
}

// A room of 4 × 5 × 3 m whose south side is open above 1 m.
Scene open_room() {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  add_quad(s, grey, {Vec3{0, 0, 0}, {4, 0, 0}, {4, 5, 0}, {0, 5, 0}});
  add_quad(s, grey, {Vec3{0, 0, 3}, {0, 5, 3}, {4, 5, 3}, {4, 0, 3}});
  add_quad(s, grey, {Vec3{0, 0, 0}, {0, 5, 0}, {0, 5, 3}, {0, 0, 3}});
  add_quad(s, grey, {Vec3{4, 0, 0}, {4, 0, 3}, {4, 5, 3}, {4, 5, 0}});
  add_quad(s, grey, {Vec3{0, 5, 0}, {4, 5, 0}, {4, 5, 3}, {0, 5, 3}});
  add_quad(s, grey, {Vec3{0, 0, 0}, {0, 0, 1}, {4, 0, 1}, {4, 0, 0}});
  return s;
}

std::vector<LightPath> path_of(const Scene& scene) {
  return {{static_path, {{"default", std::make_shared<const PreparedScene>(scene)}}}};
}

struct HoursOfEyes {
  AnnualResult result;
  std::vector<HoursOfSensor> eyes;
};

HoursOfEyes look(const Scene& scene, const WeatherYear& year,
                 const std::vector<MeasuringPoint>& eyes) {
  const std::vector<LightPath> paths = path_of(scene);
  const Compass compass = north_is_y();
  std::vector<HoursOfSensor> hours(eyes.size());
  AnnualResult result = compute_annual(
      {paths, eyes, {}, year, compass, eyes.size()}, {},
      [&](size_t eye, const HoursOfSensor& h) { hours[eye] = h; }, {}, goes_on);
  return {std::move(result), std::move(hours)};
}

// Picture of the eye's view, rated as `troffer glare` does.
DaylightGlare rated_picture(Scene scene, const WeatherStep& step, const MeasuringPoint& eye) {
  SkyRequest request;
  request.kind = SkyKind::perez;
  request.direct_normal = step.direct_normal;
  request.diffuse_horizontal = step.diffuse_horizontal;
  request.sun = SunRequest{step.sun.azimuth_deg, step.sun.altitude_deg, step.sun.distance_au, {}};
  add_sky(scene, request, north_is_y());
  Camera camera = look_at(Vec3(eye.position), Vec3(eye.position) + eye.normal, {0, 0, 1}, 90);
  camera.kind = CameraKind::fisheye;
  camera.half_extent = pi_f / 2;
  RenderOptions options;
  options.method = *Method::find("path");
  options.width = options.height = 160;
  options.spp = options.max_spp = 16;
  const PreparedScene prepared(std::move(scene));
  const RenderResult result = render(prepared, camera, options, {}, goes_on);
  Image luminances = result.layers[0].image;
  for (Rgb& p : luminances.pixels) p = Rgb{luminance(p) * float(luminous_efficacy)};
  return daylight_glare(luminances, {});
}

// Half a plate at 10 m that hides a part of the sun's disc, and 200 places across its edge.
struct EdgeOfSun {
  Scene scene = open_air();
  Vec3 to_sun;
  std::vector<Vec3d> places;
  std::vector<double> shares;  // of the disc in view
};

// From -reach to reach of the disc's radius above its middle are free. The share in view is a
// segment's area.
EdgeOfSun edge_of_sun(const WeatherYear& year, size_t hour, double reach) {
  EdgeOfSun out;
  const SunPosition& sun = year.steps[hour].sun;
  const Vec3 d(north_is_y().direction(sun.azimuth_deg, sun.altitude_deg));
  const Vec3 along = normalize(cross(d, Vec3{0, 0, 1})), up = cross(along, d);
  const Vec3 edge = d * 10, below = up * -8.0f;
  add_quad(
      out.scene, add_diffuse(out.scene, Rgb{0}),
      {edge - along * 8, edge + along * 8, edge + along * 8 + below, edge - along * 8 + below});
  out.to_sun = d;
  const double radius = 10 * std::tan(rad_from_deg(sun_angular_radius_deg));
  for (int i = 0; i < 200; ++i) {
    const double x = reach * (i - 99.5) / 100;
    out.shares.push_back(0.5 + (std::asin(x) + x * std::sqrt(1 - x * x)) / pi);
    out.places.push_back(Vec3d(up) * (x * radius));
  }
  return out;
}

}  // namespace

TEST_CASE("intervals of sensors that see a part of the sun hold it") {
  const WeatherYear year = march_day(600);
  constexpr size_t hour = 2;
  const EdgeOfSun edge = edge_of_sun(year, hour, 0.95);
  std::vector<MeasuringPoint> sensors;
  for (const Vec3d& p : edge.places) sensors.push_back({p, {0, 0, 1}});
  const HoursOfEyes hours = look(edge.scene, year, sensors);
  const SunPosition& sun = year.steps[hour].sun;
  const PerezSky sky = perez_sky(600, 250, rad_from_deg(90 - sun.altitude_deg), sun.distance_au);
  const double whole = sky.direct_lx * double(edge.to_sun.z);
  double sum = 0, expected = 0;
  int inside = 0;
  for (size_t i = 0; i < sensors.size(); ++i) {
    CAPTURE(edge.shares[i]);
    const double off = double(hours.eyes[i].sun[hour]) - whole * edge.shares[i];
    const auto error = double(hours.eyes[i].error[hour]);
    CHECK(error < 0.1 * whole);
    // All rays may miss an edge that cuts off a few per cent.
    CHECK(std::abs(off) < 4.5 * std::hypot(error, 0.01 * whole));
    inside += std::abs(off) < 1.96 * error;
    sum += double(hours.eyes[i].sun[hour]);
    expected += whole * edge.shares[i];
  }
  CHECK(inside > 180);  // of 200
  CHECK(sum == doctest::Approx(expected).epsilon(0.02));
}

// Eyes across the same edge. Their sources are the sun's part in view; the sky adds less than a
// thousandth.
TEST_CASE("eyes that see a part of the sun have a source of that size") {
  const WeatherYear year = march_day(600);
  const EdgeOfSun edge = edge_of_sun(year, 2, 0.9);
  const Compass compass = north_is_y();
  const YearSkies skies = make_year_skies(year, 1, 0.2, 1);
  const YearOutside outside{year, skies, compass};
  const PreparedScene scene(edge.scene);
  const double disc = pi * sqr(std::sin(rad_from_deg(sun_angular_radius_deg)));
  const double whole = sqr(double(skies.sun_lx[2])) / disc;
  double sum = 0, squares = 0;
  for (size_t i = 0; i < edge.places.size(); ++i) {
    const CellHit eye{Vec3(edge.places[i]), edge.to_sun, edge.to_sun, 1e-4f};
    const double share =
        double(glare_strengths({scene, outside, {}}, i, eye)[2]) / whole - edge.shares[i];
    sum += share;
    squares += sqr(share);
  }
  const auto n = double(edge.places.size());
  // Eight independent rays would deviate by 0.16.
  CHECK(std::sqrt(squares / n) < 0.13);
  CHECK(std::abs(sum / n) < 0.03);
}

// The sun ahead in the open: L = E / ω, and P = 1 on the line of sight. Patches around the sun add
// a few per cent.
TEST_CASE("an eye that looks into the sun sees a source of the sun's luminance") {
  const WeatherYear year = march_day(600);
  const SunPosition& sun = year.steps[2].sun;
  const Vec3 to_sun(north_is_y().direction(sun.azimuth_deg, sun.altitude_deg));
  const HoursOfSensor eye = look(open_air(), year, {{{0, 0, 0}, to_sun}}).eyes[0];
  const PerezSky sky = perez_sky(600, 250, rad_from_deg(90 - sun.altitude_deg), sun.distance_au);
  const double disc = pi * sqr(std::sin(rad_from_deg(sun_angular_radius_deg)));
  const double strength = sqr(sky.direct_lx) / disc;
  const double ev = double(eye.total[2]);
  CHECK(double(eye.dgp[2]) == doctest::Approx(hourly_dgp(ev, strength)).epsilon(0.01));
  // DGP is at most 1 [1].
  CHECK(hourly_dgp(30000, strength) == 1);
}

TEST_CASE("hours of an eye equal pictures rated as troffer glare does") {
  // Haze without sun: the window is the source. Sun from the side: patches of the floor, too.
  for (const double direct_normal : {0.0, 500.0}) {
    const WeatherYear year = march_day(direct_normal);
    // The second one looks slantwise at patches of sunlight.
    const std::vector<MeasuringPoint> eyes{
        {{2, 4, 1.2}, direct_normal > 0 ? Vec3{0, 1, 0} : Vec3{0, -1, 0}},
        {{2, 3, 1.6}, normalize(Vec3{0, -1, direct_normal > 0 ? -1.0f : 0})}};
    const HoursOfEyes hours = look(open_room(), year, eyes);
    for (size_t e = 0; e < eyes.size(); ++e)
      for (const size_t h : {size_t(1), size_t(2)}) {
        CAPTURE(e);
        CAPTURE(h);
        CAPTURE(direct_normal);
        const DaylightGlare g =
            rated_picture(open_room(), year.steps[hours.result.skies.steps[h]], eyes[e]);
        CHECK(double(hours.eyes[e].total[h]) == doctest::Approx(g.vertical_lx).epsilon(0.04));
        CHECK(double(hours.eyes[e].dgp[h]) == doctest::Approx(g.dgp).epsilon(0.05));
      }
  }
}

TEST_CASE("shares of glare count occupied hours above each limit") {
  YearTimes times;
  times.is_occupied = {1, 1, 1, 0};
  times.occupied = 10;  // seven of them at night
  const std::vector<float> dgp{0.36f, 0.41f, 0.46f, 0.9f};
  const auto shares = shares_of_glare(dgp, times);
  CHECK(shares[0] == doctest::Approx(0.3));
  CHECK(shares[1] == doctest::Approx(0.2));
  CHECK(shares[2] == doctest::Approx(0.1));
}

// At the equinox the sun is up for half a day everywhere; it crosses the meridian in the middle. It
// rises to 90° - latitude.
TEST_CASE("sunlight lasts as long as the day, or half of it behind a wall") {
  const WeatherYear year = march_day(500);
  const Compass compass = north_is_y();
  Scene walled = open_air();
  // In the meridian plane, to the south: it hides the sun of the morning or the afternoon.
  add_quad(walled, 0, {Vec3{0.5f, 20, -9}, {0.5f, -99, -9}, {0.5f, -99, 99}, {0.5f, 20, 99}});
  const std::vector<MeasuringPoint> points{{{0, 0, 0}, {0, -1, 0}}};
  const auto hours = [&](const Scene& scene, const SunlightDay& day) {
    return sunlight_hours(path_of(scene), points, year, compass, day, 1)[0];
  };
  CHECK(hours(open_air(), {3, 21, 0}) == doctest::Approx(12).epsilon(0.02));
  CHECK(hours(walled, {3, 21, 0}) == doctest::Approx(6).epsilon(0.04));
  CHECK(hours(open_air(), {3, 21, 43}) == 0);
  // Altitude a: sin a = cos(latitude) cos H at declination 0.
  const double h =
      deg_from_rad(std::acos(std::sin(rad_from_deg(20)) / std::cos(rad_from_deg(site_latitude))));
  CHECK(hours(open_air(), {3, 21, 20}) == doctest::Approx(2 * h / 15).epsilon(0.02));
  CHECK(sunlight_level(1.4) == "none");
  CHECK(sunlight_level(3) == "medium");
  CHECK(parse_sunlight_day("02-01,11").least_altitude_deg == 11);
  CHECK_THROWS_AS(parse_sunlight_day("02-30"), UsageError);
}

TEST_CASE("electric light is dimmed to what daylight leaves of the target") {
  // Two groups of 400 lx at a sensor each, and 100 lx at the other's.
  const std::vector<ElectricLight> lights{{"window", {400, 100}, {0, 0}},
                                          {"core", {100, 400}, {0, 0}}};
  DimmingYear dimming(lights, 500);
  dimming.add(0, std::vector<float>{0, 250, 600, 100});
  dimming.add(1, std::vector<float>{0, 0, 250, 100});
  YearTimes times;
  times.is_occupied = {1, 1, 1, 0};
  times.occupied = 4;  // one of them at night
  const std::vector<DimmedUse> use = dimming.use(times, 1);
  REQUIRE(use.size() == 2);
  CHECK(use[0].sensors == 1);
  CHECK(use[0].mean_lx == 500);
  CHECK(use[0].full_load_hours == doctest::Approx(1 + 0.5 + 0 + 1));
  CHECK(use[1].full_load_hours == doctest::Approx(1 + 1 + 0.5 + 1));
  CHECK(use[1].occupied_hours == 4);
}
