// Irradiance at points against closed forms, and coverage of the confidence intervals.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "base/random.h"
#include "light/irradiance.h"
#include "render/measure.h"
#include "support/scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

const StopFlag never_stop = false;

Scene lit_floor() {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  add_quad(s, grey, {Vec3{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}});
  add_ceiling_light(s, 1, 2, Rgb{10});
  return s;
}

// Returns the irradiance from the source of lit_floor, W/m².
double exact(const PreparedScene& scene, const MeasuringPoint& p) {
  return 10 * irradiance(scene.primitives[0], Vec3d(p.position), Vec3d(normalize(p.normal)));
}

std::vector<MeasuringPoint> floor_points(size_t n) {
  Random random(11);
  std::vector<MeasuringPoint> points(n);
  for (MeasuringPoint& p : points) {
    p.position = {4 * random.next_float() - 2, 4 * random.next_float() - 2,
                  1.5f * random.next_float()};
    p.normal = {random.next_float() - 0.5f, random.next_float() - 0.5f, 1};
  }
  return points;
}

}  // namespace

TEST_CASE("95 % intervals hold the closed form 93 to 97 % of the time") {
  const PreparedScene scene(lit_floor());
  const auto points = floor_points(4000);
  for (const Method method : {Method::path, Method::fixed}) {
    for (const int spp : {32, 256, 1024}) {
      MeasureOptions o;
      o.method = method;
      o.spp = spp;
      o.indirect = Indirect::none;
      o.seed = uint64_t(spp);
      const MeasureResult r = measure(scene, points, o, {}, never_stop);
      size_t inside = 0, lit = 0;
      for (size_t i = 0; i < points.size(); ++i) {
        const double lx = exact(scene, points[i]) * luminous_efficacy;
        const double off = std::abs(r.values[i].illuminance_lx - lx);
        if (lx < 1) continue;  // the source is barely above the horizon and most samples miss it
        ++lit;
        inside += off <= 1.96 * r.values[i].standard_error;
      }
      REQUIRE(lit > points.size() / 2);
      const double share = double(inside) / double(lit);
      CAPTURE(spp);
      CAPTURE(std::string(method.row().name));
      CHECK(share >= 0.93);
      CHECK(share <= 0.97);
    }
  }
}

TEST_CASE("estimates have no bias: z-scores of many points") {
  const PreparedScene scene(lit_floor());
  const auto points = floor_points(2000);
  MeasureOptions o;
  o.method = Method::path;
  o.spp = 512;
  o.indirect = Indirect::none;
  const MeasureResult r = measure(scene, points, o, {}, never_stop);
  double sum = 0;
  for (size_t i = 0; i < points.size(); ++i)
    if (r.values[i].standard_error > 0)  // otherwise the source is below the horizon
      sum += (r.values[i].illuminance_lx - exact(scene, points[i]) * luminous_efficacy) /
             r.values[i].standard_error;
  // The mean of n z-scores whose variance is slightly below 1 (measure.h).
  CHECK(std::abs(sum / std::sqrt(double(points.size()))) < 4);
}

TEST_CASE("a closed bright room: mean irradiance is flux / (area (1 - reflectance))") {
  // All walls emit alike, so irradiance is the same everywhere: E = pi L / (1 - rho).
  Scene s;
  const float rho = 0.6f, radiance = 2;
  const uint32_t grey = add_diffuse(s, Rgb{rho});
  for (const uint32_t quad : add_box_inside(s, grey, {0, 0, 0}, {3, 2, 2.5f}))
    make_light(s, quad, Rgb{radiance});
  const PreparedScene scene(std::move(s));
  const std::vector<MeasuringPoint> points = {{{1, 1, 0}, {0, 0, 1}},
                                              {{3, 1, 1}, {-1, 0, 0}},
                                              {{1.5f, 1, 1}, {1, 1, 1}},
                                              {{0.01f, 0.01f, 0.01f}, {0, 1, 0}}};
  MeasureOptions o;
  o.method = Method::path;
  o.spp = 1 << 15;
  const MeasureResult r = measure(scene, points, o, {}, never_stop);
  const double expected = pi * double(radiance) / (1 - double(rho));
  for (const Measurement& m : r.values) {
    CHECK(m.irradiance.g == doctest::Approx(expected).epsilon(0.005));
    CHECK(std::abs(m.illuminance_lx - expected * luminous_efficacy) < 4.5 * m.standard_error);
  }
}

// The foot of a wall that is lit from the front, then from the back; a corner of two walls; a
// table's leg.
TEST_CASE("points exactly in another surface are measured in front of it by every method") {
  for (const bool is_front_lit : {true, false}) {
    Scene s = lit_floor();
    std::array<Vec3, 4> wall{Vec3{2, -9, 0}, {2, -9, 1}, {2, 9, 1}, {2, 9, 0}};
    if (!is_front_lit) std::swap(wall[1], wall[3]);
    add_quad(s, 0, wall);
    std::array<Vec3, 4> across{Vec3{-9, 2, 0}, {-9, 2, 1}, {9, 2, 1}, {9, 2, 0}};
    if (is_front_lit) std::swap(across[1], across[3]);
    add_quad(s, 0, across);
    const PreparedScene scene(std::move(s));
    const std::vector<MeasuringPoint> points{{{2, 1, 0}, {0, 0, 1}},
                                             {{2, 2, 0}, {0, 0, 1}},
                                             {{1, 2, 0.5}, {0, 0, 1}},
                                             {{1, 1, 0}, {0, 0, 1}}};
    for (const Method m : {Method::certified, Method::fixed, Method::path}) {
      MeasureOptions o;
      o.method = m;
      o.indirect = Indirect::none;
      o.depth = 1;
      o.spp = 4096;
      const MeasureResult r = measure(scene, points, o, {}, never_stop);
      CHECK(r.in_surfaces == std::vector<size_t>{0, 1, 2});
      for (size_t i = 0; i < points.size(); ++i) {
        const double expected = is_front_lit || i == 3 ? exact(scene, points[i]) * 179 : 0;
        CAPTURE(i);
        CAPTURE(expected);
        CHECK(std::abs(r.values[i].illuminance_lx - expected) <=
              4 * r.values[i].standard_error + 2e-4 * expected);
      }
    }
  }
}

TEST_CASE("photometric scenes are measured in lux directly") {
  Scene s = lit_floor();
  s.is_photometric = true;
  const PreparedScene scene(std::move(s));
  MeasureOptions o;
  o.method = Method::path;
  o.indirect = Indirect::none;
  const std::vector<MeasuringPoint> p = {{{0, 0, 0}, {0, 0, 1}}};
  const MeasureResult r = measure(scene, p, o, {}, never_stop);
  CHECK(r.values[0].illuminance_lx == doctest::Approx(exact(scene, p[0])).epsilon(0.01));
}

TEST_CASE("measuring does not depend on the number of threads") {
  const PreparedScene scene(lit_floor());
  const auto points = floor_points(50);
  MeasureOptions o;
  o.method = Method::path;
  o.spp = 64;
  o.threads = 1;
  const MeasureResult a = measure(scene, points, o, {}, never_stop);
  o.threads = 3;
  const MeasureResult b = measure(scene, points, o, {}, never_stop);
  for (size_t i = 0; i < points.size(); ++i) {
    CHECK(a.values[i].illuminance_lx == b.values[i].illuminance_lx);
    CHECK(a.values[i].standard_error == b.values[i].standard_error);
  }
}
