// Choice between cells and paths for lists of points, and results of paths there.
#include "render/points_forecast.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "render/audit.h"
#include "render/preparation.h"
#include "render/window_room.h"
#include "support/surfaceless_lights.h"

using namespace troffer;
using namespace troffer::test;

namespace {

const StopFlag goes_on = false;

// A lamp of half a metre under a ceiling; the window is an open hole to the outside, which is dark.
PreparedScene room_with_lamp() {
  Scene s = WindowRoom::make(0.6f);
  const uint32_t grey = add_diffuse(s, Rgb{0.6f});
  make_light(
      s,
      add_quad(s, grey, {Vec3{2, 2, 2.5f}, {2, 2.5f, 2.5f}, {2.5f, 2.5f, 2.5f}, {2.5f, 2, 2.5f}}),
      Rgb{20});
  add_quad(s, grey, {Vec3{1, 1, 0.8f}, {2, 1, 0.8f}, {2, 3, 0.8f}, {1, 3, 0.8f}});
  return PreparedScene(std::move(s));
}

std::vector<MeasuringPoint> points_over_floor(int n) {
  std::vector<MeasuringPoint> points;
  for (int i = 0; i < n; ++i)
    points.push_back(
        {{0.3 + 4.4 * std::fmod(i * 0.618034, 1.0), 0.3 + 3.4 * (i + 0.5) / n, 0.1}, {0, 0, 1}});
  return points;
}

std::unique_ptr<Integrator> certified_beside_paths(const PreparedScene& scene) {
  MethodSettings settings;
  settings.measures_by_paths = true;
  settings.viewing_rays = 4096;
  return make_integrator(scene, Method::certified, settings, nullptr, nullptr);
}

PointsRun run(uint64_t seed, const StopFlag& stop = goes_on) {
  return {seed, 2, samples_per_batch(1000), nullptr, stop};
}

PointsForecast forecast(const PreparedScene& scene, int points, double error = 0.0025) {
  const auto f = forecast_points(
      *certified_beside_paths(scene), measuring_places(scene, points_over_floor(points)),
      plan_by_paths(
          {.samples = 4096, .samples_per_estimate = 1, .samples_per_direct = 32, .error = error}),
      run(1));
  REQUIRE(f);
  return *f;
}

}  // namespace

TEST_CASE("points by certified direct light plus paths agree with path tracing") {
  const PreparedScene scene = room_with_lamp();
  const auto places = measuring_places(scene, points_over_floor(200));
  const PointPlan plan{.samples = 2048, .samples_per_estimate = 1, .samples_per_direct = 32};
  const PointValues mine = measure_points(*certified_beside_paths(scene), places, plan, run(1));
  const std::unique_ptr<Integrator> path =
      make_integrator(scene, Method::path, {}, nullptr, nullptr);
  const PointValues paths =
      measure_points(*path, places, {.samples = 8192, .samples_per_estimate = 1}, run(2));
  for (const auto part : {&PointLight::direct, &PointLight::indirect, &PointLight::all}) {
    double z = 0, squares = 0, light = 0;
    for (size_t i = 0; i < places.size(); ++i) {
      const Measurement &a = mine.values[i].*part, &b = paths.values[i].*part;
      const double error = std::hypot(a.standard_error, b.standard_error);
      if (!(error > 0)) continue;
      z += (a.illuminance_lx - b.illuminance_lx) / error / std::sqrt(double(places.size()));
      squares += std::pow((a.illuminance_lx - b.illuminance_lx) / error, 2) / double(places.size());
      light += a.illuminance_lx;
    }
    CHECK(light > 0);
    CHECK(std::abs(z) < 4);
    CHECK(squares < 1.4);
  }
  // Direct light is computed without randomness, and none of it is in the other part.
  CHECK(relative_error(mine.values, &PointLight::direct) <
        0.7 * relative_error(paths.values, &PointLight::direct));
  CHECK(relative_error(mine.values, &PointLight::indirect) <
        2.3 * relative_error(paths.values, &PointLight::indirect));
}

TEST_CASE("few points are measured by paths, many by cells") {
  const PreparedScene scene = room_with_lamp();
  CHECK(forecast(scene, 4).is_for_paths());
  const PointsForecast many = forecast(scene, 2000);
  CHECK_FALSE(many.is_for_paths());
  CHECK(many.samples > 4096);
  CHECK(many.rays > many.rays_for_cells);
  CHECK(forecast(scene, 32, 0.1).is_for_paths());
}

TEST_CASE("a forecast predicts the number of samples that the error takes") {
  const PreparedScene scene = room_with_lamp();
  const PointsForecast f = forecast(scene, 32);
  const PointPlan plan{
      .samples = int(f.samples), .samples_per_estimate = 1, .samples_per_direct = 32};
  const PointValues found = measure_points(
      *certified_beside_paths(scene), measuring_places(scene, points_over_floor(32)), plan, run(3));
  const double told = relative_error(found.values, &PointLight::all);
  CAPTURE(f.samples);
  CHECK(told < 0.0025 * 1.3);
  CHECK(told > 0.0025 / 2.5);
}

TEST_CASE("if paths find no light, cells are used") {
  Scene s = WindowRoom::make(0.6f, false);  // all light comes from outside
  add_distant(s, {-0.5f, 0.1f, -0.75f}, Rgb{100});
  const PreparedScene dark(std::move(s));
  CHECK_FALSE(forecast(dark, 12).is_for_paths());
}

TEST_CASE("a lamp in a mirror, which few paths find, is sampled at all their vertices") {
  // A mirror in the opposite wall shows a lamp of 2 cm, which hardly any path would find.
  Scene s = WindowRoom::make(0.6f);
  Material mirror;
  mirror.kind = MaterialKind::conductor;
  mirror.is_reflectance = true;
  mirror.base_color = {Rgb{0.9f}, no_texture};
  const uint32_t silver = add_material(s, mirror), black = add_diffuse(s, Rgb{0});
  add_quad(s, silver, {Vec3{1, 3.9f, 0.5f}, {4, 3.9f, 0.5f}, {4, 3.9f, 2.5f}, {1, 3.9f, 2.5f}});
  make_light(
      s, add_quad(s, black, {Vec3{2, 2, 1.5f}, {2, 2, 1.52f}, {2.02f, 2, 1.52f}, {2.02f, 2, 1.5f}}),
      Rgb{4000}, true);
  const PreparedScene scene(std::move(s));
  std::vector<MeasuringPoint> points = points_over_floor(4);
  for (MeasuringPoint& p : points) p.normal = {0, 1, 0.2f};
  MeasureOptions o;
  REQUIRE(forecast_points(*certified_beside_paths(scene), measuring_places(scene, points),
                          plan_by_paths({.samples = 4096,
                                         .samples_per_estimate = 1,
                                         .samples_per_direct = 32,
                                         .error = 0.0025}),
                          run(1))
              ->is_for_paths());
  std::vector<std::vector<double>> lx(points.size());
  std::vector<double> told(points.size(), 0);
  for (o.seed = 0; o.seed < 4; ++o.seed) {
    const MeasureResult r = measure(scene, points, o, {}, goes_on);
    for (size_t i = 0; i < points.size(); ++i) {
      lx[i].push_back(r.values[i].illuminance_lx);
      told[i] += r.values[i].standard_error / 4;
    }
  }
  for (size_t i = 0; i < points.size(); ++i) {
    const auto [least, most] = std::minmax_element(lx[i].begin(), lx[i].end());
    CHECK(told[i] < 0.0045 * *least);
    CHECK(*most - *least < 5 * told[i]);
  }
}

TEST_CASE(
    "a stopped forecast does not count; lists are measured identically by any number of threads") {
  const PreparedScene scene = room_with_lamp();
  const auto points = points_over_floor(6);
  const auto places = measuring_places(scene, points);
  const StopFlag stopped = true;
  CHECK_FALSE(forecast_points(*certified_beside_paths(scene), places,
                              {.samples = 4096, .samples_per_estimate = 1}, run(1, stopped)));
  MeasureOptions o;
  o.error = 0.02;
  CHECK_FALSE(measure(scene, points, o, {}, stopped).is_complete);
  o.threads = 1;
  const MeasureResult one = measure(scene, points, o, {}, goes_on);
  o.threads = 3;
  const MeasureResult three = measure(scene, points, o, {}, goes_on);
  CHECK(one.is_complete);
  for (size_t i = 0; i < points.size(); ++i) {
    CHECK(one.values[i].illuminance_lx == three.values[i].illuminance_lx);
    CHECK(one.values[i].standard_error == three.values[i].standard_error);
    CHECK(one.values[i].standard_error < 0.0076 * one.values[i].illuminance_lx);
  }
}

TEST_CASE(
    "lists that are stopped at any time, also while cells are made, are reported as incomplete") {
  const PreparedScene scene = room_with_lamp();
  const auto points = points_over_floor(40);
  for (const int milliseconds : {1, 10, 30, 60, 100}) {
    StopFlag stop = false;
    std::thread later([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
      stop = true;
    });
    MeasureOptions o;
    o.indirect = Indirect::cells;
    o.error = 1e-4;  // takes much longer
    const MeasureResult r = measure(scene, points, o, {}, stop);
    later.join();
    CAPTURE(milliseconds);
    CHECK(r.values.size() == points.size());
    CHECK(r.is_measured.size() == points.size());
    CHECK_FALSE(r.is_complete);
  }
}
