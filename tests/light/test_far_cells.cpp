// Sky patches cover each direction once and have the light's radiance.
#include <doctest/doctest.h>

#include <cmath>

#include "base/random.h"
#include "base/units.h"
#include "base/warp.h"
#include "light/light.h"
#include "light/sky_patches.h"
#include "support/light_scenes.h"
#include "support/surfaceless_lights.h"

using namespace troffer;
using namespace troffer::test;

namespace {

Scene unit_floor() {
  Scene s;
  add_quad(s, add_diffuse(s, Rgb{0.5f}), {Vec3{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  return s;
}

// A light like a clear sky, turned away from the world's axes.
Light clear_sky(const Vec3& zenith) {
  Light e;
  e.kind = LightKind::sky;
  e.radiance = Rgb{2};
  const Frame frame(normalize(zenith));
  e.axes = {frame.tangent, frame.bitangent, frame.normal};
  e.direction = normalize(frame.tangent * -0.7f + frame.normal * -0.6f);
  e.sky = {-1, -0.32f, 10, -3, 0.45f, 1 - 10 * float(std::exp(-1.5 * pi)), Rgb{0.3f, 0.2f, 0.1f}};
  return e;
}

struct Seen {
  size_t none = 0, many = 0;
  double error = 0, sum = 0;  // root mean square error of the radiance, and mean radiance
  double difference = 0;      // between the means
};

// Compares patches and light over directions all around.
Seen look_round(const Scene& scene, const LightPrimitives& primitives, const SkyPatches& cells) {
  Seen seen;
  constexpr int n = 20000;
  Random random(5);
  for (int k = 0; k < n; ++k) {
    const float u = random.next_float();
    const Vec3 w = sphere_from_square({u, random.next_float()});
    int found = 0;
    Rgb got;
    for (const SkyPatch& cell : cells.all()) {
      if (!cell.holds(w)) continue;
      ++found;
      const Vec3 y(Vec3d(w) * (cell.height / -dot(cell.plane.normal, Vec3d(w))));
      if (cell.is_even)
        got = cell.mean;
      else
        far_radiance(cell, 1, &y.x, &y.y, &y.z, &got.r, &got.g, &got.b);
    }
    const Rgb exact = radiance_at_infinity(scene, primitives[0], {}, w);
    seen.none += found == 0 && !exact.is_black();
    seen.many += found > 1;
    seen.error += sqr(double(got.g) - double(exact.g)) / n;
    seen.sum += double(exact.g) / n;
    seen.difference += (double(got.g) - double(exact.g)) / n;
  }
  seen.error = std::sqrt(seen.error);
  return seen;
}

}  // namespace

TEST_CASE("sky patches: every direction lies in one, with the sky's radiance") {
  for (const Vec3 zenith : {Vec3{0, 0, 1}, Vec3{0, 1, 0}, Vec3{0.3f, -0.5f, 0.8f}}) {
    Scene scene = unit_floor();
    scene.lights.push_back(clear_sky(zenith));
    const LightPrimitives primitives(scene);
    const SkyPatches cells(scene, primitives);
    const Seen seen = look_round(scene, primitives, cells);
    CAPTURE(cells.all().size());
    CHECK(seen.none == 0);
    CHECK(seen.many <= 2);  // directions on an edge
    // Tables are piecewise constant around the sun.
    CHECK(seen.error < 0.015 * seen.sum);
    CHECK(std::abs(seen.difference) < 3e-4 * seen.sum);
    CHECK(cells.all().size() < 120);
  }
}

TEST_CASE("sky patches of a uniform environment: six with one radiance") {
  Scene scene = unit_floor();
  add_environment(scene, Rgb{3});
  const LightPrimitives primitives(scene);
  const SkyPatches cells(scene, primitives);
  REQUIRE(cells.all().size() == 6);
  const Seen seen = look_round(scene, primitives, cells);
  CHECK(seen.none == 0);
  CHECK(seen.error < 1e-6);
}

TEST_CASE("sky patches of an image are divided where its energy is, and send all of it") {
  Scene scene = unit_floor();
  EnvironmentMap map;
  map.width = 256;
  map.height = 128;
  map.texels.assign(256 * 128, Rgb{0.5f});
  map.texels[40 * 256 + 77] = Rgb{40000};
  scene.environments.push_back(map);
  add_light(scene, LightKind::environment, Rgb{1}).environment = 0;
  const LightPrimitives primitives(scene);
  const SkyPatches cells(scene, primitives);
  double steradians = 0, integral = 0, brightest = 0, smallest = 10;
  for (const SkyPatch& cell : cells.all()) {
    // Integrates h dA / r³ by the midpoints of a grid.
    constexpr int n = 64;
    double own = 0, light = 0;
    for (int k = 0; k < n * n; ++k) {
      const Vec3d y = cell.plane.origin + cell.plane.u * ((k % n + 0.5) / n) +
                      cell.plane.v * ((k / n + 0.5) / n) - Vec3d{0.5, 0.5, 0};
      const double d = length(y);
      const double part = cell.height * length(cell.plane.u) * length(cell.plane.v) / (d * d * d);
      const Vec3 at(y);
      Rgb l = cell.mean;
      if (!cell.is_even) far_radiance(cell, 1, &at.x, &at.y, &at.z, &l.r, &l.g, &l.b);
      own += part / (n * n);
      light += part * double(l.g) / (n * n);
    }
    CHECK(light == doctest::Approx(own * double(cell.mean.g)).epsilon(2e-3));
    steradians += own;
    integral += light;
    if (double(cell.mean.g) <= brightest) continue;
    brightest = double(cell.mean.g);
    smallest = own;
  }
  CHECK(steradians == doctest::Approx(4 * pi).epsilon(1e-4));
  CHECK(integral == doctest::Approx(primitives[0].directions->integral()).epsilon(0.01));
  CHECK(brightest > 1000);
  CHECK(smallest < 0.01);
  CHECK(cells.all().size() < 200);
}

TEST_CASE("a sun is a disk with its angular size") {
  Scene scene = unit_floor();
  Light e;
  e.kind = LightKind::sun;
  e.radiance = Rgb{1000};
  e.direction = normalize(Vec3{0.3f, 0.2f, -1});
  e.angular_radius = 0.00465f;
  scene.lights.push_back(e);
  const LightPrimitives primitives(scene);
  const SkyPatches cells(scene, primitives);
  REQUIRE(cells.all().size() == 1);
  const SkyPatch& disk = cells.all()[0];
  CHECK(disk.is_disk);
  CHECK(disk.is_even);
  const Frame frame(-e.direction);
  for (const float angle : {0.0f, 0.0046f, 0.0047f, 3.1f}) {
    const Vec3 w = frame.to_world({std::sin(angle), 0, std::cos(angle)});
    CHECK(disk.holds(w) == (angle < 0.00465f));
  }
}
