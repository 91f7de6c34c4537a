// Light from infinity at measuring points far outside the scene: it is the same there as in the
// scene.
#include <doctest/doctest.h>

#include <cmath>

#include "base/units.h"
#include "render/measure.h"
#include "support/scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace test_far_from_scene {

namespace {

const StopFlag never_stopped = false;

// A plate of 10 cm under a light from infinity.
Scene plate() {
  Scene s;
  const uint32_t black = add_diffuse(s, Rgb{0});
  add_quad(s, black,
           {Vec3{-0.05f, -0.05f, 0}, {0.05f, -0.05f, 0}, {0.05f, 0.05f, 0}, {-0.05f, 0.05f, 0}});
  return s;
}

Scene plate_in_sun() {
  Scene s = plate();
  Light sun;
  sun.name = "sun";
  sun.kind = LightKind::sun;
  sun.direction = normalize(Vec3{0.3f, 0.4f, -0.5f});  // direction of propagation
  sun.angular_radius = 0.00465f;
  sun.radiance = Rgb{1000};
  s.lights.push_back(sun);
  return s;
}

Scene plate_in_surroundings() {
  Scene s = plate();
  Light all;
  all.name = "surroundings";
  all.kind = LightKind::environment;
  all.radiance = Rgb{2};
  s.lights.push_back(all);
  return s;
}

// Points from .1 m to 1000 km away, up to ten million sizes of the scene. The plate is not in the
// way of the light.
std::vector<MeasuringPoint> points_far_off() {
  std::vector<MeasuringPoint> points;
  for (const double distance : {0.2, 1.0, 5.0, 12.0, 30.0, 100.0, 1e3, 1e4, 1e6})
    for (const Vec3d& way : {Vec3d{1, 0, 0}, Vec3d{0, -1, 0.1}, Vec3d{-0.6, 0.8, 0}})
      points.push_back({way * distance + Vec3d{0, 0, 0.01}, {0, 0, 1}});
  return points;
}

void check_everywhere(const Scene& s, double irradiance) {
  const PreparedScene scene(s);
  const std::vector<MeasuringPoint> points = points_far_off();
  for (const Method method : {Method::certified, Method::path, Method::fixed, Method::kj92}) {
    MeasureOptions o;
    o.method = method;
    o.indirect = method == Method::kj92 ? Indirect::automatic : Indirect::none;
    const MeasureResult r = measure(scene, points, o, {}, never_stopped);
    for (size_t i = 0; i < points.size(); ++i) {
      const double expected = irradiance * luminous_efficacy;
      CAPTURE(std::string(method.row().name));
      CAPTURE(length(points[i].position));
      CAPTURE(r.values[i].illuminance_lx);
      CAPTURE(expected);
      CHECK(std::abs(r.values[i].illuminance_lx - expected) <
            3e-4 * expected + 5 * r.values[i].standard_error);
      CHECK(r.values[i].standard_error < 0.02 * expected);
    }
  }
}

}  // namespace

TEST_CASE("the sun is equally bright near the scene and ten million scene sizes away") {
  // pi L sin² of the angular radius, times the cosine of incidence.
  const double sine = std::sin(0.00465), cosine = 0.5 / std::sqrt(0.5);
  check_everywhere(plate_in_sun(), 1000 * pi * sine * sine * cosine);
}

TEST_CASE("uniform surroundings are equally bright near the scene and far away") {
  // The plate hides less than the allowed error at .2 m.
  check_everywhere(plate_in_surroundings(), 2 * pi);
}

}  // namespace test_far_from_scene
