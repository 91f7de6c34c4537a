// Measuring points by cells alone, without an audit.
#include <doctest/doctest.h>

#include <cmath>

#include "methods/methods.h"
#include "render/blinds_in_the_sun.h"
#include "render/measured_points.h"
#include "render/measuring_places.h"
#include "render/preparation.h"

using namespace troffer;
using namespace troffer::test;

namespace test_points_by_cells {

namespace {

const StopFlag runs_on = false;

// A point light in one half of a room without windows; the other half gets what passes over a
// partition.
Scene room_behind_a_partition() {
  Scene s = WindowRoom::make(0.7f, false);
  constexpr float x = 2.5f, z = WindowRoom::Z - 0.1f;
  add_quad(s, add_diffuse(s, Rgb{0.7f}),
           {Vec3{x, 0, 0}, {x, 0, z}, {x, WindowRoom::Y, z}, {x, WindowRoom::Y, 0}});
  add_point(s, {3.5f, 1.7f, 1.2f}, Rgb{100});
  return s;
}

std::vector<MeasuringPoint> points_behind_the_partition(int n) {
  std::vector<MeasuringPoint> points;
  Random random(9);
  for (int i = 0; i < n; ++i) {
    MeasuringPoint& p = points.emplace_back();
    p.position = {0.2 + 2.1 * random.next_double(), 0.2 + 3.6 * random.next_double(), 0.8};
    p.normal = {0, 0, 1};
  }
  return points;
}

class List {
 public:
  List(const PreparedScene& scene, const std::vector<MeasuringPoint>& points, int threads = 2)
      : scene_(scene), places_(measuring_places(scene, points)) {
    settings_.threads = threads;
  }

  std::vector<double> by_paths(int samples) const {
    return lx_of(measured(*make_integrator(scene_, Method::path, settings_, nullptr, nullptr),
                          {.samples = samples, .samples_per_estimate = 1}, 5));
  }
  // gathering: with most_rays 0, cells do not depend on points. rays: number of rays of rows.
  std::vector<double> by_cells(int samples, const GatheringPoints& gathering, uint64_t seed,
                               uint64_t* rays = nullptr) const {
    return lx_of(values_by_cells(samples, gathering, seed, rays));
  }
  PointValues values_by_cells(int samples, const GatheringPoints& gathering, uint64_t seed,
                              uint64_t* rays = nullptr) const {
    CellInput cells{{}, nullptr, seed, nullptr, runs_on, {}, {}};
    for (const MeasuringPlace& p : places_)
      cells.pilot.places.push_back({p.position, p.normal, p.normal, p.offset});
    cells.points = gathering;
    const auto integrator = make_integrator(scene_, Method::certified, settings_, nullptr, &cells);
    if (rays != nullptr) *rays = cells.statistics.rays;
    return measured(*integrator,
                    {.samples = samples, .samples_per_estimate = 1, .samples_per_direct = 32}, 2);
  }

 private:
  PointValues measured(const Integrator& integrator, const PointPlan& plan, uint64_t seed) const {
    return measure_points(integrator, places_, plan,
                          {seed, 2, samples_per_batch(1000), nullptr, runs_on});
  }
  static std::vector<double> lx_of(const PointValues& found) {
    std::vector<double> lx;
    for (const PointLight& p : found.values) lx.push_back(p.all.illuminance_lx);
    return lx;
  }

  const PreparedScene& scene_;
  std::vector<MeasuringPlace> places_;
  MethodSettings settings_;
};

double relative_rms(const std::vector<double>& a, const std::vector<double>& b) {
  double squares = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const double off = a[i] / b[i] - 1;
    squares += off * off;
  }
  return std::sqrt(squares / double(a.size()));
}

}  // namespace

TEST_CASE("behind slats, points by cells are right where narrow cells are refined") {
  const PreparedScene scene(blinds_in_the_sun());
  const List list(scene, points_above(12));
  const std::vector<double> paths = list.by_paths(1 << 16);
  constexpr int samples = 1 << 15;
  CHECK(relative_rms(list.by_cells(samples, {}, 1), paths) > 0.2);
  CHECK(relative_rms(list.by_cells(samples, {samples, samples, 0}, 1), paths) < 0.024);
}

TEST_CASE("cells for many accurate points have more rays and less noise") {
  const PreparedScene scene(room_behind_a_partition());
  const List list(scene, points_behind_the_partition(16));
  constexpr int samples = 1 << 13;
  uint64_t rays = 0;
  // Cells of different seeds, read by the same gather rays.
  std::vector<double> first;  // of the last call
  const auto noise = [&](const GatheringPoints& gathering) {
    first = list.by_cells(samples, gathering, 1, &rays);
    double squares = 0;
    constexpr int others = 2;
    for (uint64_t seed = 2; seed < 2 + others; ++seed)
      squares += std::pow(relative_rms(list.by_cells(samples, gathering, seed), first), 2);
    return std::sqrt(squares / others);
  };
  const double before = noise({samples, samples, 0});
  const uint64_t usual = rays;
  const double now = noise({samples, 32 * samples, 0.0025});
  CAPTURE(usual);
  CAPTURE(rays);
  CAPTURE(before);
  CAPTURE(now);
  CHECK(first == List(scene, points_behind_the_partition(16), 3)
                     .by_cells(samples, {samples, 32 * samples, 0.0025}, 1));
  CHECK(rays > 3 * usual);
  CHECK(now < 0.6 * before);
}

// With few and with many rays of cells.
TEST_CASE("the error of cells is included in the estimate of every point") {
  const PreparedScene scene(room_behind_a_partition());
  std::vector<MeasuringPoint> points = points_behind_the_partition(6);
  // Just below the gap, where some cells are far brighter than others.
  points.push_back({{2.4, 2, 2.7}, {1, 0, 0}});
  const List list(scene, points);
  constexpr int samples = 1 << 13, seeds = 6;
  for (const int times : {1, 32}) {
    CAPTURE(times);
    std::vector<PointValues> found;
    for (uint64_t seed = 0; seed < seeds; ++seed)
      found.push_back(list.values_by_cells(
          samples, {double(samples), double(times * samples), times > 1 ? 0.0025 : 0}, seed));
    double made = 0, told = 0, by_samples = 0;
    for (size_t i = 0; i < points.size(); ++i) {
      double sum = 0, squares = 0, noise = 0, spread = 0;
      for (const PointValues& f : found) {
        const double e = f.values[i].all.illuminance_lx;
        sum += e;
        squares += e * e;
        noise += std::pow(f.values[i].shared_error, 2);
        spread += std::pow(f.values[i].all.standard_error, 2);
      }
      const double mean = sum / seeds;
      made += (squares - sum * mean) / (seeds - 1) / (mean * mean);
      told += (noise + spread) / seeds / (mean * mean);
      by_samples += spread / seeds / (mean * mean);
    }
    CAPTURE(std::sqrt(made / double(points.size())));
    CAPTURE(std::sqrt(told / double(points.size())));
    CHECK(by_samples < 0.5 * told);
    CHECK(std::sqrt(told / made) > 0.7);
    CHECK(std::sqrt(told / made) < 1.6);
  }
  const GatheringPoints gathering{samples, samples, 0};
  const PointValues one = list.values_by_cells(samples, gathering, 3),
                    another = List(scene, points, 3).values_by_cells(samples, gathering, 3);
  for (size_t i = 0; i < points.size(); ++i)
    CHECK(one.values[i].shared_error == another.values[i].shared_error);
}

// In a room with lamps of 60 cm, 5 cm below the ceiling, over louvres of 5 cm.
TEST_CASE("points in the gap behind a luminaire get the light that enters at its edges") {
  Scene room = WindowRoom::make(0.7f, false);
  const uint32_t grey = add_diffuse(room, Rgb{0.7f});
  constexpr float x = 2, y = 2, r = 0.3f, z = WindowRoom::Z;
  const uint32_t lamp = add_quad(room, grey,
                                 {Vec3{x - r, y - r, z - 0.05f},
                                  {x - r, y + r, z - 0.05f},
                                  {x + r, y + r, z - 0.05f},
                                  {x + r, y - r, z - 0.05f}});
  make_light(room, lamp, Rgb{15});
  for (int k = 0; k <= 20; ++k) {
    const float t = r * (float(k) / 10 - 1), low = z - 0.2f, high = z - 0.15f;
    add_quad(
        room, grey,
        {Vec3{x + t, y - r, low}, {x + t, y + r, low}, {x + t, y + r, high}, {x + t, y - r, high}});
    add_quad(
        room, grey,
        {Vec3{x - r, y + t, low}, {x + r, y + t, low}, {x + r, y + t, high}, {x - r, y + t, high}});
  }
  const PreparedScene scene(std::move(room));
  std::vector<MeasuringPoint> points;
  for (const double off : {0.0, 0.12, -0.2})
    for (const double below : {0.015, 0.03})
      points.push_back({{double(x) + off, double(y) - 0.25, double(z) - below}, {0, 0, -1}});
  const size_t in_gap = points.size();
  for (int i = 0; i < 8; ++i) points.push_back({{0.5 + 0.5 * i, 1 + 0.2 * i, 0.8}, {0, 0, 1}});
  const List list(scene, points);
  constexpr int samples = 1 << 16;
  const std::vector<MeasuringPoint> gap(points.begin(), points.begin() + std::ptrdiff_t(in_gap));
  const std::vector<double> paths = List(scene, gap).by_paths(samples),
                            cells = list.by_cells(samples, {samples, samples, 0}, 1);
  double ratio = 0;
  for (size_t i = 0; i < in_gap; ++i) ratio += cells[i] / paths[i] / double(in_gap);
  CHECK(ratio == doctest::Approx(1).epsilon(0.012));
}

TEST_CASE("direct light is as accurate if only few of many samples include it") {
  Scene room = WindowRoom::make(0.5f);
  const uint32_t grey = add_diffuse(room, Rgb{0.6f});
  Random random(3);
  const auto between = [&](float low, float high) {
    return low + (high - low) * random.next_float();
  };
  for (int i = 0; i < 3000; ++i) {
    const Vec3 c{between(0.3f, 4.5f), between(0.3f, 3.7f), between(0.2f, 2.5f)};
    const Vec3 along = random_direction(random) * 0.15f, across = random_direction(random) * 0.01f;
    add_quad(room, grey,
             {c - along - across, c + along - across, c + along + across, c - along + across});
  }
  add_environment(room, Rgb{1});
  const PreparedScene scene(std::move(room));
  const std::vector<MeasuringPlace> places =
      measuring_places(scene, std::vector<MeasuringPoint>{{{4.55f, 1.5f, 0.1f}, {0, 0, 1}}});
  MethodSettings settings;
  settings.threads = 2;
  settings.measures_by_paths = true;
  settings.error = 0.01;
  settings.viewing_rays = 4096;
  const auto integrator = make_integrator(scene, Method::certified, settings, nullptr, nullptr);
  const auto direct = [&](int samples, int samples_per_direct) {
    const PointPlan plan{
        .samples = samples, .samples_per_estimate = 1, .samples_per_direct = samples_per_direct};
    return measure_points(*integrator, places, std::span(&plan, 1),
                          {7, 2, samples_per_batch(1), nullptr, runs_on})
        .values[0]
        .direct;
  };
  const Measurement usual = direct(1 << 12, 32), few = direct(1 << 16, 512);
  CAPTURE(usual.standard_error);
  CAPTURE(few.standard_error);
  CHECK(usual.standard_error > 0);
  CHECK(few.standard_error < 3 * usual.standard_error);
  CHECK(std::abs(few.illuminance_lx - usual.illuminance_lx) <
        4 * std::hypot(few.standard_error, usual.standard_error));
}

TEST_CASE("rays of cells among translucent leaves do not branch at every leaf") {
  Scene room = WindowRoom::make(0.5f);
  Material m;
  m.base_color.value = Rgb{0.3f};
  m.diffuse_transmission.value = 1;
  m.diffuse_transmission_color.value = Rgb{0.3f};
  const uint32_t leaf = add_material(room, m);
  Random random(3);
  const auto about = [&](float middle) {
    float sum = -2;
    for (int k = 0; k < 4; ++k) sum += random.next_float();
    return middle + 0.4f * sum;
  };
  for (int i = 0; i < 6000; ++i) {
    const Vec3 c{about(i % 3 == 0 ? 1.5f : 4), about(i % 2 == 0 ? 1 : 3), about(1.2f)};
    const Vec3 along = random_direction(random) * 0.05f, across = random_direction(random) * 0.02f;
    add_quad(room, leaf, {c - along, c + across, c + along, c - across});
  }
  add_environment(room, Rgb{1});
  const PreparedScene scene(std::move(room));
  CellInput cells{{}, nullptr, 1, nullptr, runs_on, {}, {}};
  cells.pilot.places.push_back({{2, 2, 0.1f}, {0, 0, 1}, {0, 0, 1}, 1e-5f});
  cells.points = {4096, 4096, 0};
  MethodSettings settings;
  settings.threads = 2;
  REQUIRE(make_integrator(scene, Method::certified, settings, nullptr, &cells));
  CAPTURE(cells.statistics.rays);
  CAPTURE(cells.statistics.entries);
  // At most the two sides of the leaf at which a ray ends.
  CHECK(double(cells.statistics.entries) < 2 * double(cells.statistics.rays));
}

}  // namespace test_points_by_cells
