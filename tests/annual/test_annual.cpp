// The whole calculation: open air against closed forms, and a room with a window against `measure`
// under the same skies.
#include "annual/annual.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "base/units.h"
#include "daylight/sky_model.h"
#include "render/measure.h"
#include "support/scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

const StopFlag never_stop = false;
constexpr double place_latitude = 48;

// The world of these scenes: z is up, y is north.
Compass compass() {
  return make_compass({0, 0, 1}, 0, false);
}

// Every third hour of a day in four months, with sun and haze.
WeatherYear few_hours() {
  WeatherYear year;
  year.latitude_deg = place_latitude;
  for (const int month : {3, 6, 9, 12})
    for (double hour = 6.5; hour < 20; hour += 3) {
      WeatherStep& s = year.steps.emplace_back();
      s.month = month;
      s.day = 21;
      s.hour = hour;
      s.hour_of_year = (month * 30 - 9) * 24 + hour;
      s.sun = sun_position(place_latitude, 0, julian_day(2015, month, 21, hour));
      s.direct_normal = month == 9 ? 0 : 500;
      s.diffuse_horizontal = 150;
    }
  return year;
}

struct Hours {
  AnnualResult result;
  std::vector<HoursOfSensor> sensors;
};

Hours run(const std::vector<LightPath>& paths, const std::vector<MeasuringPoint>& points,
          const AnnualOptions& options) {
  std::vector<HoursOfSensor> sensors;
  const WeatherYear year = few_hours();
  const Compass directions = compass();
  AnnualResult result = compute_annual(
      {paths, points, {{0, points.size()}}, year, directions}, options,
      [&](size_t, const HoursOfSensor& h) { sensors.push_back(h); }, {}, never_stop);
  return {std::move(result), std::move(sensors)};
}

// Paths of a scene without groups. The scene must outlive them.
std::vector<LightPath> only(const PreparedScene& scene) {
  return {{static_path, {{"default", {&scene, [](const PreparedScene*) {}}}}}};
}

Hours run(const PreparedScene& scene, const std::vector<MeasuringPoint>& points,
          const AnnualOptions& options) {
  return run(only(scene), points, options);
}

// Light of hour h as lights of a scene.
void add_light_of(const WeatherStep& step, Scene& scene) {
  SkyRequest request;
  request.kind = SkyKind::perez;
  request.direct_normal = step.direct_normal;
  request.diffuse_horizontal = step.diffuse_horizontal;
  request.sun = SunRequest{step.sun.azimuth_deg, step.sun.altitude_deg, step.sun.distance_au, {}};
  add_sky(scene, request, compass());
}

Scene far_quad() {
  Scene s;
  const uint32_t m = add_diffuse(s, Rgb{0.5f});
  add_quad(s, m, {Vec3{-1, -1, -9}, {1, -1, -9}, {1, 1, -9}, {-1, 1, -9}});
  return s;
}

// A room of 4 × 6 × 3 m with a window in its south wall, at y = 0, which is 0.3 m thick.
Scene window_room() {
  Scene s;
  const uint32_t m = add_diffuse(s, Rgb{0.6f, 0.5f, 0.4f});
  add_quad(s, m, {Vec3{0, 0, 0}, {4, 0, 0}, {4, 6, 0}, {0, 6, 0}});
  add_quad(s, m, {Vec3{0, 0, 3}, {0, 6, 3}, {4, 6, 3}, {4, 0, 3}});
  add_quad(s, m, {Vec3{0, 0, 0}, {0, 6, 0}, {0, 6, 3}, {0, 0, 3}});
  add_quad(s, m, {Vec3{4, 0, 0}, {4, 0, 3}, {4, 6, 3}, {4, 6, 0}});
  add_quad(s, m, {Vec3{0, 6, 0}, {4, 6, 0}, {4, 6, 3}, {0, 6, 3}});
  for (const float y : {0.0f, -0.3f}) {  // two leaves of the wall
    add_quad(s, m, {Vec3{0, y, 0}, {0, y, 3}, {1, y, 3}, {1, y, 0}});
    add_quad(s, m, {Vec3{3, y, 0}, {3, y, 3}, {4, y, 3}, {4, y, 0}});
    add_quad(s, m, {Vec3{1, y, 0}, {1, y, 1}, {3, y, 1}, {3, y, 0}});
    add_quad(s, m, {Vec3{1, y, 2.5f}, {1, y, 3}, {3, y, 3}, {3, y, 2.5f}});
  }
  add_quad(s, m, {Vec3{1, 0, 1}, {3, 0, 1}, {3, -0.3f, 1}, {1, -0.3f, 1}});
  add_quad(s, m, {Vec3{1, 0, 2.5f}, {1, -0.3f, 2.5f}, {3, -0.3f, 2.5f}, {3, 0, 2.5f}});
  add_quad(s, m, {Vec3{1, 0, 1}, {1, -0.3f, 1}, {1, -0.3f, 2.5f}, {1, 0, 2.5f}});
  add_quad(s, m, {Vec3{3, 0, 1}, {3, 0, 2.5f}, {3, -0.3f, 2.5f}, {3, -0.3f, 1}});
  return s;
}

}  // namespace

TEST_CASE("a sensor in the open gets sky and sun by closed forms") {
  const PreparedScene scene(far_quad());
  const Hours year = run(scene, {{{0, 0, 0}, {0, 0, 1}}, {{0, 0, 0}, {0, 0, -1}}}, {});
  const WeatherYear weather = few_hours();
  REQUIRE(year.result.skies.hours() > 10);
  for (size_t h = 0; h < year.result.skies.hours(); ++h) {
    const WeatherStep& s = weather.steps[year.result.skies.steps[h]];
    const double zenith = rad_from_deg(90 - s.sun.altitude_deg);
    const PerezSky sky =
        perez_sky(s.direct_normal, s.diffuse_horizontal, zenith, s.sun.distance_au);
    const double global = sky.diffuse_lx + sky.direct_lx * std::cos(zenith);
    CHECK(double(year.sensors[0].total[h]) == doctest::Approx(global).epsilon(1e-4));
    CHECK(double(year.sensors[0].sun[h]) ==
          doctest::Approx(sky.direct_lx * std::cos(zenith)).epsilon(1e-4));
    // A quad of 2 × 2 m, 9 m below, hides 4/(81 pi) of the ground and shows half of its own light.
    CHECK(double(year.sensors[1].total[h]) == doctest::Approx(0.2 * global).epsilon(0.05));
  }
}

// Perez' skies are smooth but near the sun, so 2305 patches reproduce vertical illuminance to
// within half a per cent.
TEST_CASE("a vertical sensor in the open equals measure under the same skies") {
  const std::vector<MeasuringPoint> points{{{0, 0, 0}, {0, -1, 0}}, {{0, 0, 0}, {1, 0, 0}}};
  const PreparedScene dark(far_quad());
  const Hours year = run(dark, points, {});
  const WeatherYear weather = few_hours();
  for (size_t h = 0; h < year.result.skies.hours(); h += 3) {
    Scene lit = far_quad();
    add_light_of(weather.steps[year.result.skies.steps[h]], lit);
    const MeasureResult m = measure(PreparedScene(lit), points, {}, {}, never_stop);
    for (size_t i = 0; i < points.size(); ++i)
      CHECK(double(year.sensors[i].total[h]) ==
            doctest::Approx(m.values[i].illuminance_lx).epsilon(0.005));
  }
}

// The cells of a replicate and its grid of suns err, and the error must say so. Patches of the sky
// have a bias that it leaves out: 0.5 % of the illuminance here.
TEST_CASE("hours of a room with a window equal measure within the estimated errors") {
  const std::vector<MeasuringPoint> points{{{2, 1, 0.8}, {0, 0, 1}},
                                           {{1, 3, 0.8}, {0, 0, 1}},
                                           {{3, 5, 0.8}, {0, 0, 1}},
                                           {{2, 4, 1.2}, {0, -1, 0}}};
  const PreparedScene dark(window_room());
  const Hours year = run(dark, points, {});
  const WeatherYear weather = few_hours();
  double squares = 0;
  size_t count = 0;
  for (size_t h = 0; h < year.result.skies.hours(); h += 2) {
    CAPTURE(h);
    Scene lit = window_room();
    add_light_of(weather.steps[year.result.skies.steps[h]], lit);
    const MeasureResult m = measure(PreparedScene(lit), points, {}, {}, never_stop);
    for (size_t i = 0; i < points.size(); ++i) {
      CAPTURE(i);
      const double lx = m.values[i].illuminance_lx, found = double(year.sensors[i].total[h]);
      const double error = std::hypot(m.values[i].standard_error, double(year.sensors[i].error[h]));
      const double z = (found - lx) / std::hypot(error, 0.005 * lx);
      CHECK(std::abs(z) < 4.5);
      squares += z * z;
      ++count;
      CHECK(double(year.sensors[i].error[h]) < 0.15 * lx);
    }
  }
  CHECK(squares / double(count) < 2);
}

TEST_CASE("results do not depend on the number of threads") {
  const PreparedScene scene(window_room());
  const std::vector<MeasuringPoint> points{{{2, 1, 0.8}, {0, 0, 1}}, {{1, 3, 0.8}, {0, 0, 1}}};
  AnnualOptions options;
  options.rays_of_sensor = 128;
  options.subdivision = 1;
  options.threads = 1;
  const Hours one = run(scene, points, options);
  options.threads = 3;
  const Hours three = run(scene, points, options);
  for (size_t i = 0; i < points.size(); ++i) {
    CHECK(one.sensors[i].total == three.sensors[i].total);
    CHECK(one.sensors[i].error == three.sensors[i].error);
  }
}

TEST_CASE("a stop ends the calculation") {
  const PreparedScene scene(window_room());
  const std::vector<LightPath> paths = only(scene);
  const std::vector<MeasuringPoint> points{{{2, 1, 0.8}, {0, 0, 1}}};
  const WeatherYear year = few_hours();
  const Compass directions = compass();
  const StopFlag stop = true;
  CHECK(!compute_annual({paths, points, {{0, 1}}, year, directions}, {}, {}, {}, stop).is_complete);
}
