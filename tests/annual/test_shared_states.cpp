// States that share cells and rays: regions in which their scenes differ, and the light of each
// state against the same scene computed alone.
#include <doctest/doctest.h>

#include <cmath>
#include <optional>

#include "annual/annual.h"
#include "annual/sensor_states.h"
#include "annual/window_groups.h"
#include "base/random.h"
#include "support/scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace shared_states {

const StopFlag goes_on = false;

void add_named(Scene& s, const std::string& name, uint32_t m, const std::array<Vec3, 4>& corners) {
  add_quad(s, m, corners);
  s.meshes.back().name = name;
}

// A room of 4 × 4 × 3 m with a pane in each of the south and the west wall, whose upper edge is
// under a lintel of 1 m. Slats at 45° hang 5 cm outside the southern pane, a drop of diffusing
// cloth inside the western one. Ground lies before the south wall.
Scene slatted_room(bool is_glossy) {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.6f}), dark = add_diffuse(s, Rgb{0.2f});
  Material glass;
  glass.kind = MaterialKind::dielectric;
  glass.is_thin = true;
  glass.ior = 1.5f;
  const uint32_t pane = add_material(s, glass);
  Material cloth;
  cloth.base_color.value = Rgb{0.4f};
  cloth.diffuse_transmission.value = 1;
  cloth.diffuse_transmission_color.value = Rgb{0.2f};
  const uint32_t woven = add_material(s, cloth);
  Material varnish;
  varnish.kind = MaterialKind::coated_diffuse;
  varnish.base_color.value = Rgb{0.3f};
  varnish.roughness.value = 0.1f;
  const uint32_t floor = is_glossy ? add_material(s, varnish) : dark;
  add_named(s, "floor", floor, {Vec3{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  add_named(s, "ceiling", grey, {Vec3{0, 0, 3}, {0, 4, 3}, {4, 4, 3}, {4, 0, 3}});
  add_named(s, "east", grey, {Vec3{4, 0, 0}, {4, 0, 3}, {4, 4, 3}, {4, 4, 0}});
  add_named(s, "north", grey, {Vec3{0, 4, 0}, {4, 4, 0}, {4, 4, 3}, {0, 4, 3}});
  add_named(s, "lintel", grey, {Vec3{0, 0, 2}, {0, 0, 3}, {4, 0, 3}, {4, 0, 2}});
  add_named(s, "lintel", grey, {Vec3{0, 0, 2}, {0, 4, 2}, {0, 4, 3}, {0, 0, 3}});
  add_named(s, "ground", dark, {Vec3{-9, -9, -1}, {9, -9, -1}, {9, 0, -1}, {-9, 0, -1}});
  add_named(s, "pane south", pane, {Vec3{0, 0, 0}, {0, 0, 2}, {4, 0, 2}, {4, 0, 0}});
  add_named(s, "pane west", pane, {Vec3{0, 0, 0}, {0, 4, 0}, {0, 4, 2}, {0, 0, 2}});
  for (int k = 0; k < 6; ++k) {
    const float low = 0.34f * float(k), high = low + 0.34f;
    add_named(s, "slat", grey,
              {Vec3{0, -0.05f, high}, {0, -0.39f, low}, {4, -0.39f, low}, {4, -0.05f, high}});
  }
  add_named(s, "cloth", woven, {Vec3{0.1f, 0, 0}, {0.1f, 4, 0}, {0.1f, 4, 2}, {0.1f, 0, 2}});
  return s;
}

const std::vector<WindowGroup> groups{
    {"South", {"pane south"}, {{"up", {}, 1, "", ""}, {"down", {"slat"}, 1, "", ""}}},
    {"West", {"pane west"}, {{"up", {}, 1, "", ""}, {"down", {"cloth"}, 1, "", ""}}}};

PathState state_of(const Scene& scene, std::optional<size_t> south, std::optional<size_t> west) {
  const std::array<std::optional<size_t>, 2> states{south, west};
  return {"state",
          std::make_shared<const PreparedScene>(with_window_states(scene, {groups, {}}, states))};
}

std::vector<LightPath> paths_of(const Scene& scene) {
  return {{static_path, {state_of(scene, {}, {})}},
          {"South", {state_of(scene, 0, {}), state_of(scene, 1, {})}},
          {"West", {state_of(scene, {}, 0), state_of(scene, {}, 1)}}};
}

const std::vector<MeasuringPoint> points{
    {{2, 2, 0.8}, {0, 0, 1}}, {{1, 3, 1.2}, {0, -1, 0}}, {{3, 1, 0.4}, {-1, 0, 0}}};

// Hours of a March day, one of them with sun.
WeatherYear day() {
  WeatherYear year;
  year.latitude_deg = 48;
  for (int k = 0; k < 12; ++k) {
    WeatherStep& s = year.steps.emplace_back();
    s.month = 3;
    s.day = 21;
    s.hour = 7.5 + k;
    s.hour_of_year = 79 * 24 + s.hour;
    s.sun = sun_position(48, 0, julian_day(2015, 3, 21, s.hour));
    s.direct_normal = k == 3 ? 20 : 0;
    s.diffuse_horizontal = 150;
  }
  return year;
}

struct StatesRun {
  AnnualResult result;
  std::vector<HoursOfSensor> sensors;
};

StatesRun run(const std::vector<LightPath>& paths, uint64_t seed, int threads = 0) {
  const WeatherYear year = day();
  const Compass compass = make_compass({0, 0, 1}, 0, false);
  AnnualOptions options;
  options.blinds = "open";
  options.subdivision = 1;
  options.rays_of_sensor = 2048;
  options.seed = seed;
  options.threads = threads;
  std::vector<HoursOfSensor> sensors;
  AnnualResult result = compute_annual(
      {paths, points, {{0, points.size()}}, year, compass}, options,
      [&](size_t, const HoursOfSensor& h) { sensors.push_back(h); }, {}, goes_on);
  return {std::move(result), std::move(sensors)};
}

// Exposure of all sensors in a year with blinds open: mean and variance of the mean.
struct Exposure {
  double mean = 0, variance = 0;
};
Exposure exposure_of(const StatesRun& run) {
  constexpr size_t sets = size_t(replicate_count);
  std::array<double, sets> sums{};
  Exposure e;
  for (size_t r = 0; r < sets; ++r) {
    for (size_t s = 0; s < points.size(); ++s)
      sums[r] += run.result.figures.at(s, r + 1)[size_t(SensorFigure::exposure_klxh)];
    e.mean += sums[r] / double(sets);
  }
  for (const double sum : sums) e.variance += (sum - e.mean) * (sum - e.mean);
  e.variance /= double(sets * (sets - 1));
  return e;
}

// Compares a state that is the open one of its group with the scene computed alone.
void compare_with_state_alone(const std::vector<LightPath>& paths, const StatesRun& all,
                              size_t path, size_t state) {
  CAPTURE(path);
  CAPTURE(state);
  LightPath group = paths[path];
  std::swap(group.states[0], group.states[state]);
  const StatesRun shared = run({paths[0], group}, 1);
  const Exposure together = exposure_of(shared);
  const Exposure alone = exposure_of(run({{static_path, {group.states[0]}}}, 2));
  CAPTURE(together.mean);
  CAPTURE(alone.mean);
  // Closed slats are the noisiest state: 5.73 klx h as the mean of 24 runs, with a deviation of
  // 2.4 % of one run. Errors estimated from the eight replicates of a run are 0.7 to 2.7 %.
  const double error = std::sqrt(together.variance + alone.variance);
  CHECK(error < 0.05 * alone.mean);
  CHECK(std::abs(together.mean - alone.mean) < 3.5 * error);
  if (path == 1 && state == 1) {
    constexpr double converged = 5.73, deviation = 0.14;  // of one run
    for (const double mean : {together.mean, alone.mean})
      CHECK(std::abs(mean - converged) < 3.5 * deviation);
  }
  // Other groups make no difference at all.
  for (size_t s = 0; s < points.size(); ++s) {
    CHECK(shared.sensors[s].states[1].total == all.sensors[s].states[2 * path - 1 + state].total);
    CHECK(shared.sensors[s].states[0].total == all.sensors[s].states[0].total);
  }
}

// Open states are compared below, in the sum over windows.
TEST_CASE("states that share rays and cells have the light of the same scenes alone") {
  const std::vector<LightPath> paths = paths_of(slatted_room(false));
  const StatesRun all = run(paths, 1, 1);
  compare_with_state_alone(paths, all, 1, 1);
  compare_with_state_alone(paths, all, 2, 1);
}

TEST_CASE("the same on a floor with gloss, by which rays reach windows") {
  const std::vector<LightPath> paths = paths_of(slatted_room(true));
  const StatesRun all = run(paths, 1);
  compare_with_state_alone(paths, all, 2, 1);
}

// The northern wall is a window outside of all groups. Its light is in the scenes of all states.
TEST_CASE("light of windows outside of all groups counts once") {
  Scene scene = slatted_room(false);
  std::erase_if(scene.meshes, [](const Mesh& m) { return m.name == "north"; });
  const StatesRun apart = run(paths_of(scene), 1);
  const StatesRun whole = run({{static_path, {state_of(scene, 0, 0)}}}, 2);
  const Exposure sum = exposure_of(apart), light = exposure_of(whole);
  CAPTURE(sum.mean);
  CAPTURE(light.mean);
  const double error = std::sqrt(sum.variance + light.variance);
  CHECK(error < 0.02 * light.mean);
  CHECK(std::abs(sum.mean - light.mean) < 4 * error + 0.01 * light.mean);
  for (size_t s = 0; s < points.size(); ++s)
    for (size_t h = 0; h < whole.sensors[s].sun.size(); ++h) {
      const auto sun = double(whole.sensors[s].sun[h]);
      CHECK(std::abs(double(apart.sensors[s].sun[h]) - sun) <= 0.1 * sun);  // penumbras differ
      const std::vector<HoursOfState>& states = apart.sensors[s].states;
      const float all = states[0].total[h] + states[1].total[h] + states[3].total[h];
      CHECK(double(apart.sensors[s].total[h]) == doctest::Approx(double(all)).epsilon(1e-4));
    }
}

TEST_CASE("direct rays that states share equal those of the scenes alone") {
  const std::vector<LightPath> paths = paths_of(slatted_room(false));
  const std::vector<StateFamily> families = LitStates(paths, points).families();
  REQUIRE(families.size() == 1);
  REQUIRE(families[0].states.size() == 5);
  const WeatherYear year = day();
  const Compass compass = make_compass({0, 0, 1}, 0, false);
  const YearSkies skies = make_year_skies(year, 2, 0.2, 1);
  const YearOutside outside{year, skies, compass, 7};
  for (size_t s = 0; s < points.size(); ++s) {
    const DirectRays rays(outside, families[0], s, DirectRays::Parts::all);
    for (const StateOfFamily& state : families[0].states) {
      const std::vector<LightPath> one{{static_path, {{"", state.scene}}}};
      const std::vector<StateFamily> own = LitStates(one, points).families();
      const DirectRays alone(outside, own[0], s, DirectRays::Parts::all);
      const std::vector<float> open = rays.open_in(state);
      CHECK(open == alone.open_in(own[0].states[0]));
      const bool has_light = std::any_of(open.begin(), open.end(), [](float o) { return o > 0; });
      CHECK(has_light == (state.number > 0 && state.number < 4));  // none passes the cloth straight
    }
  }
}

TEST_CASE("states that move a sensor or the scene's origin are not compared with others") {
  const Scene scene = slatted_room(false);
  std::vector<LightPath> paths = paths_of(scene);
  const std::vector<MeasuringPoint> on_cloth{{{0.1, 2, 1}, {0, 0, 1}}};
  CHECK(LitStates(paths, on_cloth).families().size() == 2);
  Scene moved = scene;
  moved.origin = {100, 0, 0};
  CHECK(LitStates({paths[0], {"moved", {state_of(moved, {}, {})}}}, points).families().size() == 2);
}

// Random rays through two heaps of boxes.
TEST_CASE("a ray that misses a region meets none of its boxes") {
  Random random(5);
  const auto place = [&](float size) {
    return Vec3(random.next_float(), random.next_float(), random.next_float()) * size;
  };
  std::vector<Box> boxes;
  for (int i = 0; i < 40; ++i) {
    const Vec3 lower = place(8) + Vec3(i < 20 ? 0.0f : 20.0f);
    boxes.push_back({lower, lower + place(0.5f)});
  }
  const std::vector<Box> few = few_boxes(boxes, 3);
  CHECK(few.size() <= 3);
  RayRegions regions;
  regions.add({});
  regions.add(few);
  std::vector<uint32_t> met;
  int missed = 0, hit = 0;
  for (int i = 0; i < 20000; ++i) {
    Ray ray;
    ray.origin = place(30);
    const Vec3 target = i % 2 == 0 ? place(30) : boxes[size_t(i) % 40].centre();
    ray.direction = normalize(target - ray.origin);
    met.clear();
    regions.find(ray, met);
    if (i % 2 == 1) CHECK(met == std::vector<uint32_t>{1});
    (met.empty() ? missed : hit)++;
  }
  CHECK(missed > 1000);
  CHECK(hit > 11000);
  for (const Box& b : boxes) CHECK(regions.holds(1, b.centre(), 0));
  CHECK(!regions.holds(1, {15, 15, 15}, 1));
  CHECK(!regions.holds(0, boxes[0].centre(), 100));
}

}  // namespace shared_states
