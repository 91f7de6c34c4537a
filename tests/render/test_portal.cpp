// Portals: windows marked for an image or a uniform sky, by all methods.
#include <doctest/doctest.h>

#include <cmath>

#include "base/units.h"
#include "light/irradiance.h"
#include "pictures.h"
#include "render/measure.h"
#include "support/light_scenes.h"
#include "support/surfaceless_lights.h"
#include "window_room.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// Returns a rectangle in the wall at x = 5, larger than the window by this margin on all sides.
std::vector<Vec3> portal(float by) {
  constexpr float X = WindowRoom::X, y0 = WindowRoom::y0, y1 = WindowRoom::y1, z0 = WindowRoom::z0,
                  z1 = WindowRoom::z1;
  return {
      {X, y0 - by, z0 - by}, {X, y0 - by, z1 + by}, {X, y1 + by, z1 + by}, {X, y1 + by, z0 - by}};
}

// Bright around one direction, from which the window lets light onto some of the floor.
EnvironmentMap bright_spot() {
  EnvironmentMap map;
  map.projection = SphereMap::lat_long;
  map.width = 64;
  map.height = 32;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x)
      map.texels.push_back(Rgb{y >= 10 && y < 12 && x < 2 ? 200.0f : 0.2f + 0.02f * float(x % 8)});
  return map;
}

std::vector<Measurement> measured(const PreparedScene& scene,
                                  const std::vector<MeasuringPoint>& points, Method method, int spp,
                                  Indirect indirect = Indirect::none, int threads = 2) {
  MeasureOptions o;
  o.method = method;
  o.spp = spp;
  o.indirect = indirect;
  if (indirect == Indirect::none) o.depth = 1;
  o.threads = threads;
  o.error = 0.01;
  return measure(scene, points, o, {}, never_stopped).values;
}

// Compares the means of the values by their ratio and its error.
void check_same(const std::vector<Measurement>& a, const std::vector<Measurement>& b) {
  double sum_a = 0, sum_b = 0, variance = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    sum_a += double(a[i].irradiance.g);
    sum_b += double(b[i].irradiance.g);
    variance += (sqr(a[i].standard_error) + sqr(b[i].standard_error)) / sqr(luminous_efficacy);
  }
  CAPTURE(sum_a);
  CAPTURE(sum_b);
  CHECK(std::abs(sum_a - sum_b) < 4 * std::sqrt(variance));
  CHECK(std::sqrt(variance) < 0.05 * sum_a);
}

double variance_of(const std::vector<Measurement>& values) {
  double sum = 0;
  for (const Measurement& m : values) sum += sqr(m.standard_error);
  return sum;
}

Scene lit(Scene s, bool has_image, const std::vector<Vec3>& through) {
  Light& e = add_light(s, LightKind::environment, Rgb{1});
  e.portal = through;
  if (!has_image) return s;
  s.environments.push_back(bright_spot());
  e.environment = 0;
  return s;
}

}  // namespace

TEST_CASE("a portal over a window does not change the light and removes most variance of paths") {
  for (const bool has_image : {false, true}) {
    CAPTURE(has_image);
    const PreparedScene with(lit(WindowRoom::make(0), has_image, portal(0.1f)));
    const PreparedScene without(lit(WindowRoom::make(0), has_image, {}));
    const auto points = WindowRoom::points();
    const auto reference = measured(without, points, Method::certified, 64);
    check_same(measured(with, points, Method::certified, 64), reference);
    check_same(measured(with, points, Method::fixed, 1024), reference);
    const auto paths = measured(with, points, Method::path, 4096);
    check_same(paths, reference);
    const auto far = measured(without, points, Method::path, 4096);
    CHECK(variance_of(paths) < (has_image ? 0.4 : 0.2) * variance_of(far));
  }
}

// The window is larger than the portal, so the portal's own sides decide.
TEST_CASE(
    "through a portal smaller than the window its own form factor arrives, with all methods") {
  const auto p = portal(-0.15f);
  const PreparedScene scene(lit(WindowRoom::make(0), false, p));
  const auto points = WindowRoom::points();
  const Vec3d outline[4] = {Vec3d(p[0]), Vec3d(p[3]), Vec3d(p[2]), Vec3d(p[1])};
  for (const Method method : {Method::certified, Method::path, Method::fixed, Method::kj92}) {
    const auto values = measured(scene, points, method, method == Method::path ? 4096 : 64);
    double squares = 0, variance = 0;
    for (size_t i = 0; i < points.size(); ++i) {
      const double expected =
          polygon_irradiance(outline, Vec3d(points[i].position), {0, 0, 1}, Sides::both);
      squares += sqr(double(values[i].irradiance.g) / expected - 1) / double(points.size());
      variance +=
          sqr(values[i].standard_error / luminous_efficacy / expected) / double(points.size());
    }
    CHECK(std::sqrt(squares) < (method == Method::kj92 ? 0.05 : 0.02));
    CHECK(std::sqrt(variance) < 0.02);
  }
}

TEST_CASE("a light gives nothing outside of its portal; total light is the same with all methods") {
  Scene s = lit(WindowRoom::make(0.5f), false, portal(0.1f));
  add_quad(s, 0, {Vec3{5.5f, 0, 0}, {8, 0, 0}, {8, 4, 0}, {5.5f, 4, 0}});
  const PreparedScene scene(std::move(s));
  const std::vector<MeasuringPoint> outside = {{{6, 2, 0.1f}, {0, 0, 1}},
                                               {{7, 1, 0.1f}, {-1, 0, 0}}};
  for (const Method method : {Method::certified, Method::path})
    for (const Measurement& m : measured(scene, outside, method, 64))
      CHECK(m.irradiance.is_black());
  const auto points = WindowRoom::points();
  const auto cells = measured(scene, points, Method::certified, 16, Indirect::automatic);
  check_same(measured(scene, points, Method::path, 4096, Indirect::automatic), cells);
  const auto one = measured(scene, points, Method::certified, 16, Indirect::automatic, 1);
  for (size_t i = 0; i < points.size(); ++i) CHECK(one[i].irradiance == cells[i].irradiance);
}
