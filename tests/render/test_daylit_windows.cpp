// Light from infinity through openings: certified light against closed forms and rays.
#include <doctest/doctest.h>

#include <cmath>

#include "base/random.h"
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

std::vector<Measurement> measured(const PreparedScene& scene,
                                  const std::vector<MeasuringPoint>& points, Method method, int spp,
                                  int threads = 2, double error = 0.01) {
  MeasureOptions o;
  o.method = method;
  o.spp = spp;
  o.indirect = Indirect::none;
  o.threads = threads;
  o.error = error;
  return measure(scene, points, o, {}, never_stopped).values;
}

}  // namespace

TEST_CASE("a window under a uniform sky gives its form factor times pi L") {
  Scene s = WindowRoom::make(0);
  add_environment(s, Rgb{2});
  const PreparedScene scene(std::move(s));
  const Vec3d window[4] = {{5, 1, 0.9f}, {5, 3, 0.9f}, {5, 3, 2.1f}, {5, 1, 2.1f}};
  const auto points = WindowRoom::points();
  const auto values = measured(scene, points, Method::certified, 64, 2, 0.002);
  double squares = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const double expected =
        2 * polygon_irradiance(window, Vec3d(points[i].position), {0, 0, 1}, Sides::both);
    const double error = values[i].standard_error / luminous_efficacy;
    CAPTURE(i);
    CHECK(double(values[i].irradiance.g) == doctest::Approx(expected).epsilon(2e-3));
    CHECK(error < 2e-3 * expected);
    squares += sqr(double(values[i].irradiance.g) / expected - 1) / double(points.size());
  }
  CHECK(std::sqrt(squares) < 1e-3);
}

TEST_CASE("a closed room is dark under any sky, sun and image") {
  Scene s = WindowRoom::make(0, false);
  add_environment(s, Rgb{2});
  Light& sun = add_light(s, LightKind::sun, Rgb{1e6f});
  sun.direction = normalize(Vec3{-1, 0.2f, -0.7f});
  sun.angular_radius = 0.00465f;
  const PreparedScene scene(std::move(s));
  for (const Measurement& m : measured(scene, WindowRoom::points(), Method::certified, 4))
    CHECK(m.irradiance.g == 0);
}

// No part of the sky is visible from inside, so it must not cost anything.
TEST_CASE("a sky and a sun cause neither rays nor masks in a closed room") {
  const auto counters_of = [](bool has_sky) {
    Scene s = WindowRoom::make(0, false);
    const uint32_t grey = add_diffuse(s, Rgb{0.5f});
    add_box_inside(s, grey, {3, 1, 0}, {4, 2, 1});
    make_light(s, add_quad(s, grey, {Vec3{1, 1, 2.6f}, {1, 2, 2.6f}, {2, 2, 2.6f}, {2, 1, 2.6f}}),
               Rgb{10});
    if (has_sky) {
      add_environment(s, Rgb{2});
      Light& sun = add_light(s, LightKind::sun, Rgb{1e6f});
      sun.direction = normalize(Vec3{-1, 0.2f, -0.7f});
      sun.angular_radius = 0.00465f;
    }
    const PreparedScene scene(std::move(s));
    RenderOptions o;
    o.width = 32;
    o.height = 24;
    o.indirect = Indirect::none;
    const RenderResult r =
        render_now(scene, look_at({.3f, .4f, 1.6f}, {4, 3, .5f}, {0, 0, 1}, 70), o);
    return r.statistics.counters;
  };
  const Counters without = counters_of(false), with = counters_of(true);
  CHECK(without.masked > 0);
  CHECK(with.shadow_rays == without.shadow_rays);
  CHECK(with.masked == without.masked);
  CHECK(with.mixed == without.mixed);
  CHECK(with.dark_certified > without.dark_certified);
}

namespace {

// A room whose walls are boxes side by side, so no single surface encloses it. A slit of `slit`
// metres may remain above a wall.
Scene thick_room(float slit, bool has_sky) {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  constexpr float X = 5, Y = 4, Z = 2.7f, T = 0.2f;
  add_box_inside(s, grey, {-T, -T, -T}, {X + T, Y + T, 0});
  add_box_inside(s, grey, {-T, -T, 0}, {0, Y + T, Z});
  add_box_inside(s, grey, {X, -T, 0}, {X + T, Y + T, Z - slit});
  add_box_inside(s, grey, {0, -T, 0}, {X, 0, Z});
  add_box_inside(s, grey, {0, Y, 0}, {X, Y + T, Z});
  add_box_inside(s, grey, {-T, -T, Z}, {X + T, Y + T, Z + T});
  make_light(s, add_quad(s, grey, {Vec3{1, 1, 2.6f}, {1, 2, 2.6f}, {2, 2, 2.6f}, {2, 1, 2.6f}}),
             Rgb{5});
  if (has_sky) add_environment(s, Rgb{20});
  return s;
}

}  // namespace

// Certificates for single sky patches would cost far more than all other light.
TEST_CASE(
    "a room with thick walls that seems closed gets few rays, and no light through slits is lost") {
  const Camera camera = look_at({.3f, .4f, 1.6f}, {4, 3, .5f}, {0, 0, 1}, 70);
  RenderOptions o;
  o.width = 24;
  o.height = 18;
  o.indirect = Indirect::none;
  const auto counters_of = [&](bool has_sky) {
    const PreparedScene scene(thick_room(0, has_sky));
    return render_now(scene, camera, o).statistics.counters;
  };
  const Counters without = counters_of(false), with = counters_of(true);
  // The sky may change which further rays are cheapest, but none of its 145 patches is masked.
  CHECK(double(with.masked) < 1.2 * double(without.masked));
  CHECK(with.shadow_rays < 4 * with.viewing_rays);
  for (const float slit : {0.003f, 0.05f}) {
    const PreparedScene scene(thick_room(slit, true));
    o.method = Method::certified;
    o.spp = o.max_spp = 4;
    const Ensemble mine = render_ensemble(scene, camera, o, 16);
    o.method = Method::fixed;
    o.spp = o.max_spp = 64;
    const Ensemble fixed = render_ensemble(scene, camera, o, 16);
    CAPTURE(slit);
    CHECK(p_of_difference(mine.mean, fixed.mean) > 1e-4);
  }
}

TEST_CASE(
    "the sun's patch on the floor has the sun's light, and its edge the width of the sun's "
    "penumbra") {
  Scene s = WindowRoom::make(0);
  const double irradiance = 500, radius = 0.00465;
  Light& sun = add_light(s, LightKind::sun, Rgb{float(irradiance / (pi * sqr(std::sin(radius))))});
  sun.direction = normalize(Vec3{-1, 0, -1});
  sun.angular_radius = float(radius);
  const PreparedScene scene(std::move(s));
  // The window's sill puts the edge of the patch at x = 5 - 0.9, whatever y. The sun's penumbra is
  // about 2 radius × 0.9 √2 / sin 45° wide.
  const double width = 2 * radius * 0.9 * std::sqrt(2.0) * std::sqrt(2.0);
  std::vector<MeasuringPoint> points;
  for (const double x : {4.1 - 2 * width, 4.1, 4.1 + 2 * width})
    points.push_back({{float(x), 2, 0}, {0, 0, 1}});
  const auto values = measured(scene, points, Method::certified, 64);
  const double full = irradiance * std::sqrt(0.5);
  CHECK(double(values[0].irradiance.g) == doctest::Approx(full).epsilon(1e-3));
  CHECK(double(values[1].irradiance.g) == doctest::Approx(full / 2).epsilon(0.02));
  CHECK(values[2].irradiance.g == 0);
}

// More occluders before the window than a facet list can hold: rays sample what is left of the sky.
TEST_CASE(
    "a thicket in front of a window: same mean as rays, same bytes for any number of threads") {
  Scene s = WindowRoom::make(0);
  const uint32_t m = add_diffuse(s, Rgb{0});
  Random random(11);
  for (int i = 0; i < 6000; ++i) {
    const float y = 0.8f + 2.4f * random.next_float(), z = 0.8f + 1.4f * random.next_float();
    const float x = 5.1f + 0.5f * random.next_float(), d = 0.02f;
    add_quad(s, m, {Vec3{x, y, z}, {x + d, y + d, z}, {x + d, y + d, z + d}, {x, y, z + d}});
  }
  add_environment(s, Rgb{2});
  const PreparedScene scene(std::move(s));
  const auto points = WindowRoom::points();
  const auto mine = measured(scene, points, Method::certified, 256);
  const auto alone = measured(scene, points, Method::certified, 256, 1);
  const auto rays = measured(scene, points, Method::fixed, 16384);
  double sum = 0, variance = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    CAPTURE(i);
    CHECK(mine[i].irradiance == alone[i].irradiance);
    const double error = std::hypot(mine[i].standard_error, rays[i].standard_error);
    CHECK(std::abs(double(mine[i].irradiance.g) - double(rays[i].irradiance.g)) <
          5 * error / luminous_efficacy + 1e-3 * double(rays[i].irradiance.g));
    sum += double(mine[i].irradiance.g) - double(rays[i].irradiance.g);
    variance += sqr(error / luminous_efficacy);
  }
  CHECK(std::abs(sum) < 4 * std::sqrt(variance));
}

namespace {

// A thousand leaves over a plain with a matte or a coated surface.
Scene tree(bool is_glossy) {
  Scene s;
  const uint32_t m = add_diffuse(s, Rgb{0.6f});
  if (is_glossy) {
    s.materials[m].kind = MaterialKind::coated_diffuse;
    s.materials[m].roughness.value = 0.3f;
  }
  add_quad(s, m, {Vec3{-30, -30, 0}, {30, -30, 0}, {30, 30, 0}, {-30, 30, 0}});
  Random random(5);
  const auto about_zero = [&] { return random.next_float() + random.next_float() - 1; };
  for (int i = 0; i < 1000; ++i) {
    const Vec3 at{3 * about_zero(), 3 * about_zero(), 3 + 1.6f * about_zero()};
    const Vec3 a = normalize(Vec3{about_zero(), about_zero(), about_zero()}) * 0.12f;
    const Vec3 b = normalize(Vec3{about_zero(), about_zero(), about_zero()}) * 0.12f;
    add_quad(s, m, {at + a, at + b, at - a, at - b});
  }
  return s;
}

}  // namespace

// Certificates do not help here and must not cost more than the rays that they would save.
TEST_CASE(
    "a tree in the open: same mean as fixed rays, with few rays and hardly any certificates") {
  for (const bool is_glossy : {false, true}) {
    Scene s = tree(is_glossy);
    add_environment(s, Rgb{2});
    Light& sun = add_light(s, LightKind::sun, Rgb{5e4f});
    sun.direction = normalize(Vec3{-1, 0.4f, -1});
    sun.angular_radius = 0.00465f;
    const PreparedScene scene(std::move(s));
    const Camera camera = look_at({0, -7, 1.7f}, {0, 0, 1.5f}, {0, 0, 1}, 60);
    RenderOptions o;
    o.width = 24;
    o.height = 18;
    o.indirect = Indirect::none;
    o.max_spp = 16;
    const RenderResult once = render_now(scene, camera, o);
    o.threads = 1;
    CHECK(is_identical(once.layers, render_now(scene, camera, o).layers));
    o.threads = 2;
    const Counters& c = once.statistics.counters;
    CAPTURE(is_glossy);
    CAPTURE(c.shadow_rays);
    CAPTURE(c.viewing_rays);
    CAPTURE(c.masked);
    CHECK(c.shadow_rays < 45 * c.viewing_rays);
    const Ensemble mine = render_ensemble(scene, camera, o, 16);
    o.method = Method::fixed;
    o.spp = o.max_spp = 16;
    const Ensemble fixed = render_ensemble(scene, camera, o, 16);
    CHECK(p_of_difference(mine.mean, fixed.mean) > 1e-4);
    size_t off = 0;
    for (size_t i = 0; i < mine.pixels.size(); ++i)
      off += p_of_difference(mine.pixels[i], fixed.pixels[i], 1e-6) < 1e-6 ? 1 : 0;
    CHECK(off == 0);
  }
}
