// Window groups: what a file may say, scenes in their states, light of paths, and operation of
// blinds.
#include "annual/window_groups.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>

#include "annual/annual.h"
#include "annual/blinds.h"
#include "base/error.h"
#include "support/scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

const StopFlag runs_on = false;

// A file that lives as long as the object.
class TextFile {
 public:
  TextFile(const std::string& ending, const std::string& text)
      : path_(std::filesystem::temp_directory_path() /
              fmt::format("troffer-groups-{}{}", getpid(), ending)) {
    std::ofstream(path_) << text;
  }
  ~TextFile() { std::filesystem::remove(path_); }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

std::string error_of(const std::string& json) {
  const TextFile file(".json", json);
  try {
    read_window_groups(file.path());
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

void add_wall(Scene& s, const std::string& name, uint32_t m, const std::array<Vec3, 4>& corners) {
  add_quad(s, m, corners);
  s.meshes.back().name = name;
}

// A room of 4 × 4 × 3 m whose south wall (y = 0) and west wall (x = 0) are clear panes, and a blind
// outside the south pane. All but panes and floor are matte grey.
Scene two_windows() {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  Material glass;
  glass.name = "glass";
  glass.kind = MaterialKind::dielectric;
  glass.is_thin = true;
  glass.ior = 1;
  s.materials.push_back(glass);
  const auto pane = uint32_t(s.materials.size() - 1);
  add_wall(s, "floor", grey, {Vec3{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  add_wall(s, "ceiling", grey, {Vec3{0, 0, 3}, {0, 4, 3}, {4, 4, 3}, {4, 0, 3}});
  add_wall(s, "east", grey, {Vec3{4, 0, 0}, {4, 0, 3}, {4, 4, 3}, {4, 4, 0}});
  add_wall(s, "north", grey, {Vec3{0, 4, 0}, {4, 4, 0}, {4, 4, 3}, {0, 4, 3}});
  add_wall(s, "pane south", pane, {Vec3{0, 0, 0}, {0, 0, 3}, {4, 0, 3}, {4, 0, 0}});
  add_wall(s, "pane west", pane, {Vec3{0, 0, 0}, {0, 4, 0}, {0, 4, 3}, {0, 0, 3}});
  add_wall(s, "blind", grey, {Vec3{-9, -0.1f, -1}, {-9, -0.1f, 9}, {9, -0.1f, 9}, {9, -0.1f, -1}});
  return s;
}

const std::vector<WindowGroup> groups{
    {"South", {"pane s*"}, {{"up", {}, 1, "", ""}, {"down", {"blind"}, 1, "", ""}}},
    {"West", {"pane west"}, {{"clear", {}, 1, "", ""}, {"tinted", {}, 0.5, "", ""}}}};

using States = std::vector<std::optional<size_t>>;

bool has_mesh(const Scene& scene, const std::string& name) {
  for (const Mesh& m : scene.meshes)
    if (m.name == name) return true;
  return false;
}

const Material& material_of(const Scene& scene, const std::string& name) {
  for (const Mesh& m : scene.meshes)
    if (m.name == name) return scene.materials[m.material];
  FAIL("no mesh " << name);
  return scene.materials[0];
}

PathState state_of(const std::string& name, const States& states) {
  return {name, std::make_shared<const PreparedScene>(
                    with_window_states(two_windows(), {groups, {}}, states))};
}

// Midday and afternoon hours of a March day, with sun and haze.
constexpr double last_hour = 17.5;
WeatherYear sunny_hours(double last = last_hour) {
  WeatherYear year;
  year.latitude_deg = 48;
  for (double hour = 10.5; hour <= last; hour += 1) {
    WeatherStep& s = year.steps.emplace_back();
    s.month = 3;
    s.day = 21;
    s.hour = hour;
    s.hour_of_year = 79 * 24 + hour;
    s.sun = sun_position(48, 0, julian_day(2015, 3, 21, hour));
    s.direct_normal = 500;
    s.diffuse_horizontal = 150;
  }
  return year;
}

struct YearOfSensors {
  AnnualResult result;
  std::vector<HoursOfSensor> sensors;
};

YearOfSensors run(const std::vector<LightPath>& paths, const std::string& blinds,
                  double last = last_hour) {
  const std::vector<MeasuringPoint> points{{{2, 2, 0.8}, {0, 0, 1}},
                                           {{3, 1, 0.8}, {0, 0, 1}},
                                           {{1, 3, 1.2}, {0, -1, 0}},
                                           {{2, 3, 1.2}, {-1, 0, 0}}};
  const WeatherYear year = sunny_hours(last);
  const Compass compass = make_compass({0, 0, 1}, 0, false);
  AnnualOptions options;
  options.blinds = blinds;
  options.subdivision = 2;
  std::vector<HoursOfSensor> sensors;
  AnnualResult result = compute_annual(
      {paths, points, {{0, points.size()}}, year, compass}, options,
      [&](size_t, const HoursOfSensor& h) { sensors.push_back(h); }, {}, runs_on);
  return {std::move(result), std::move(sensors)};
}

std::vector<LightPath> two_paths() {
  return {{static_path, {state_of("default", {std::nullopt, std::nullopt})}},
          {"South", {state_of("up", {0, std::nullopt}), state_of("down", {1, std::nullopt})}},
          {"West", {state_of("clear", {std::nullopt, 0}), state_of("tinted", {std::nullopt, 1})}}};
}

}  // namespace

TEST_CASE("a file of groups is read, and mistakes are named with their place") {
  const TextFile file(".json",
                      R"({"groups":[{"name":"South","windows":["pane*"],"states":[
                          {"name":"up"},{"shown":["blind"],"transmittance":0.5}]},
                          {"name":"Roof","windows":["roof"]}]})");
  const std::vector<WindowGroup> read = read_window_groups(file.path()).groups;
  REQUIRE(read.size() == 2);
  REQUIRE(read[0].states.size() == 2);
  CHECK(read[0].states[0].name == "up");
  CHECK(read[0].states[1].name == "state 1");
  CHECK(read[0].states[1].shown == std::vector<std::string>{"blind"});
  CHECK(read[0].states[1].transmittance == 0.5);
  CHECK(read[1].states.size() == 1);
  CHECK(error_of("{\"groups\":[\n{\"name\":\"a\"}]}").find(":2:1:") != std::string::npos);
  CHECK(error_of(R"({"groups":[{"name":"a","windows":["w"],"state":[]}]})").find("states") !=
        std::string::npos);
  CHECK(error_of(R"({"groups":[{"name":"a","windows":["w"],"states":[{"transmittance":2}]}]})")
            .find("from 0 to 1") != std::string::npos);
  CHECK(error_of(R"({"groups":[{"name":"a","windows":["w"]},{"name":"a","windows":["v"]}]})")
            .find("another group") != std::string::npos);
}

TEST_CASE("groups must fit the scene") {
  const Scene scene = two_windows();
  CHECK_NOTHROW(check_window_groups(scene, groups));
  const auto with = [](const std::string& window, const WindowState& state) {
    return std::vector<WindowGroup>{{"g", {window}, {state}}};
  };
  CHECK_THROWS_AS(check_window_groups(scene, with("door", {"s", {}, 1, "", ""})), UsageError);
  CHECK_THROWS_AS(check_window_groups(scene, with("pane west", {"s", {"slat*"}, 1, "", ""})),
                  UsageError);
  CHECK_THROWS_AS(check_window_groups(scene, with("pane west", {"s", {}, 1, "cloth", ""})),
                  UsageError);
  CHECK_THROWS_AS(check_window_groups(scene, with("floor", {"s", {}, 0.5, "", ""})), UsageError);
  std::vector<WindowGroup> twice = groups;
  twice[1].windows = {"pane*"};
  CHECK_THROWS_AS(check_window_groups(scene, twice), UsageError);
}

TEST_CASE("a scene shows the parts of its states, and black windows of other groups") {
  const Scene open = with_window_states(two_windows(), {groups, {}}, States{0, 0});
  CHECK(!has_mesh(open, "blind"));
  CHECK(material_of(open, "pane south").name == "glass");
  const Scene down = with_window_states(two_windows(), {groups, {}}, States{1, std::nullopt});
  CHECK(has_mesh(down, "blind"));
  CHECK(material_of(down, "pane south").name == "glass");
  CHECK(material_of(down, "pane west").base_color.value.is_black());
  CHECK(material_of(down, "pane west").kind == MaterialKind::diffuse);
  const Scene tinted = with_window_states(two_windows(), {groups, {}}, States{std::nullopt, 1});
  CHECK(!has_mesh(tinted, "blind"));
  CHECK(std::exp(-tinted.materials[tinted.meshes[5].material].absorption.g) ==
        doctest::Approx(0.5));
}

// Light is linear. The room has no way by both windows but for light that a window returns outside,
// which no surface sends back.
TEST_CASE("the sum of paths is the light of the whole scene") {
  const YearOfSensors apart = run(two_paths(), "open");
  const YearOfSensors whole = run({{static_path, {state_of("default", {0, 0})}}}, "open");
  for (size_t s = 0; s < whole.sensors.size(); ++s)
    for (size_t h = 0; h < whole.sensors[s].total.size(); ++h) {
      const auto lx = double(whole.sensors[s].total[h]);
      const double error = std::hypot(double(whole.sensors[s].error[h]),
                                      double(apart.sensors[s].error[h]), 0.005 * lx);
      CAPTURE(s);
      CAPTURE(h);
      CHECK(std::abs(double(apart.sensors[s].total[h]) - lx) < 4.5 * error);
      CHECK(double(apart.sensors[s].sun[h]) ==
            doctest::Approx(double(whole.sensors[s].sun[h])).epsilon(1e-4));
      // Neither group lights the path of other windows, and the blind covers its window.
      CHECK(apart.sensors[s].states[0].total[h] == 0);
      CHECK(apart.sensors[s].states[2].sun[h] == 0);
      // A tint of half lets at most half of the sun pass: less at a slant.
      CHECK(double(apart.sensors[s].states[4].sun[h]) <=
            0.5001 * double(apart.sensors[s].states[3].sun[h]));
    }
}

TEST_CASE("blinds close against the sun of their own window, and a table overrules them") {
  const YearOfSensors lm83 = run(two_paths(), "lm-83");
  const size_t hours = lm83.result.skies.hours();
  bool is_closed = false, is_tinted = false;
  for (size_t h = 0; h < hours; ++h) {
    bool has_sun = false;
    for (const HoursOfSensor& s : lm83.sensors)
      has_sun = has_sun || s.states[1].sun[h] + s.states[3].sun[h] >= 1000;
    // One of four sensors is more than 2 %.
    const StateSchedule& schedule = lm83.result.schedule;
    CHECK((schedule.of(1)[h] + schedule.of(2)[h] > 0) == has_sun);
    is_closed = is_closed || schedule.of(1)[h] == 1;
    is_tinted = is_tinted || schedule.of(2)[h] == 1;
    for (const HoursOfSensor& s : lm83.sensors) {
      const float sum = s.states[0].total[h] + s.states[1 + schedule.of(1)[h]].total[h] +
                        s.states[3 + schedule.of(2)[h]].total[h];
      CHECK(s.total[h] == doctest::Approx(double(sum)).epsilon(1e-4));
    }
  }
  CHECK(is_closed);
  CHECK(is_tinted);
  const TextFile table(".csv", "West\n1\n0\n");
  const YearOfSensors by_table = run(two_paths(), table.path(), 11.5);
  CHECK(by_table.result.schedule.of(1)[1] == 0);
  CHECK(by_table.result.schedule.of(2)[0] == 1);
  CHECK(by_table.result.schedule.of(2)[1] == 0);
  CHECK_THROWS_AS(run(two_paths(), TextFile(".csv", "West\n1\n").path()), InputError);
  CHECK_THROWS_AS(run(two_paths(), TextFile(".csv", "East\n1\n").path()), InputError);
}

// The rule of honeybee-radiance-postprocess, leed_schedule.py: the group that lights most sensors
// closes first, and the sum over groups must comply.
TEST_CASE("groups close in order of the sensors they light, until 2 % remain") {
  const std::shared_ptr<const PreparedScene> none;
  const std::vector<LightPath> paths{{"A", {{"0", none}, {"1", none}}},
                                     {"B", {{"0", none}, {"1", none}}},
                                     {static_path, {{"default", none}}}};
  // 100 sensors. Hour 0: A lights 5 of them, B 2. Hour 1: each lights 2 of the same sensors with
  // half of the limit, and 2 % comply. Hour 2: both light 3. Hour 3: fixed windows light all.
  std::vector<SunOfPath> sun(3);
  for (SunOfPath& p : sun) {
    p.open.resize(100);
    p.closed.resize(100);
  }
  const auto light = [&](size_t path, size_t first, size_t count, uint32_t hour, float lx) {
    for (size_t s = first; s < first + count; ++s) sun[path].open[s].push_back({hour, lx});
  };
  light(0, 0, 5, 0, 1000);
  light(1, 10, 2, 0, 1000);
  light(0, 0, 2, 1, 500);
  light(1, 0, 2, 1, 500);
  light(0, 0, 3, 2, 600);
  light(1, 0, 3, 2, 600);
  light(2, 0, 100, 3, 5000);
  const std::vector<SensorSpan> grids{{0, 100}};
  const StateSchedule s = lm83_schedule(paths, sun, grids, 4);
  CHECK(s.of(0)[0] == 1);
  CHECK(s.of(1)[0] == 0);
  CHECK(s.of(0)[1] + s.of(1)[1] == 0);
  CHECK(s.of(0)[2] == 1);  // one of equals suffices
  CHECK(s.of(1)[2] == 0);
  CHECK(s.of(0)[3] + s.of(1)[3] == 0);  // no sun by way of them
  CHECK(s.of(2)[3] == 0);
  // Two grids: a group closes if one of them asks for it.
  const std::vector<SensorSpan> rooms{{0, 5}, {5, 95}};
  CHECK(lm83_schedule(paths, sun, rooms, 4).of(1)[0] == 1);
}
