// Fabrics by EN 14501's figures: light through a wide sheet in closed form, sunlight and skylight
// apart, and what a file may say.
#include "annual/fabric.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>

#include "annual/annual.h"
#include "annual/window_groups.h"
#include "base/error.h"
#include "base/units.h"
#include "support/scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

const StopFlag no_fabric_stop = false;

std::string message_for(const std::string& json) {
  const std::string path =
      (std::filesystem::temp_directory_path() / fmt::format("troffer-fabrics-{}.json", getpid()))
          .string();
  std::ofstream(path) << json;
  std::string message;
  try {
    read_window_groups(path);
  } catch (const InputError& e) {
    message = e.what();
  }
  std::filesystem::remove(path);
  return message;
}

// Sunny and overcast hours.
WeatherYear some_hours() {
  WeatherYear year;
  year.latitude_deg = 48;
  for (double hour = 9.5; hour < 15; hour += 2) {
    WeatherStep& s = year.steps.emplace_back();
    s.month = 6;
    s.day = 21;
    s.hour = hour;
    s.hour_of_year = 172 * 24 + hour;
    s.sun = sun_position(48, 0, julian_day(2015, 6, 21, hour));
    s.direct_normal = hour > 10 ? 700 : 0;
    s.diffuse_horizontal = 150;
  }
  return year;
}

// A level sheet of 400 × 400 m, a metre above the sensor, and a window far away.
Scene sheet() {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  add_quad(s, grey, {Vec3{-200, -200, 1}, {200, -200, 1}, {200, 200, 1}, {-200, 200, 1}});
  s.meshes.back().name = "screen";
  add_quad(s, grey, {Vec3{900, 900, 1}, {900.1f, 900, 1}, {900.1f, 900.1f, 1}, {900, 900.1f, 1}});
  s.meshes.back().name = "window";
  return s;
}

struct SheetYear {
  std::vector<HoursOfSensor> sensors;  // below the sheet, above it
  WeatherYear year = some_hours();
};

SheetYear year_below(const Fabric& fabric) {
  const WindowGroups groups{{{"g", {"window"}, {{"down", {"screen"}, 1, "", fabric.name}}}},
                            {fabric}};
  const std::vector<std::optional<size_t>> shown{0};
  const PreparedScene scene(with_window_states(sheet(), groups, shown));
  const std::vector<LightPath> paths{
      {static_path, {{"default", {&scene, [](const PreparedScene*) {}}}}}};
  const std::vector<MeasuringPoint> points{{{0, 0, 0}, {0, 0, 1}}, {{0, 0, 2}, {0, 0, 1}}};
  SheetYear out;
  const Compass compass = make_compass({0, 0, 1}, 0, false);
  compute_annual(
      {paths, points, {{0, 2}}, out.year, compass}, {},
      [&](size_t, const HoursOfSensor& h) { out.sensors.push_back(h); }, {}, no_fabric_stop);
  return out;
}

}  // namespace

// Above the sheet there is the open sky, with illuminance G. Below, the sun and the sky shine
// through the holes, the sheet has the luminance τ_diffuse G / π all over, and it reflects the
// ground, whose luminance is 0.2 G / π.
TEST_CASE("light below a wide sheet follows from openness, transmittance and reflectance") {
  for (const Fabric& f : {Fabric{"screen", 0.05, 0.17, 0.4}, Fabric{"blackout", 0, 0.02, 0.6},
                          Fabric{"net", 0.3, 0.3, 0.1}}) {
    CAPTURE(f.name);
    const SheetYear found = year_below(f);
    const HoursOfSensor &below = found.sensors[0], &above = found.sensors[1];
    REQUIRE(below.total.size() == 3);
    for (size_t h = 0; h < 3; ++h) {
      CAPTURE(h);
      const auto global = double(above.total[h]), sun = double(above.sun[h]);
      CHECK((sun > 0) == (h > 0));
      CHECK(double(below.sun[h]) == doctest::Approx(f.openness * sun).epsilon(1e-4));
      const double expected = global * (f.transmittance + f.reflectance * 0.2);
      CAPTURE(below.error[h]);
      CHECK(double(below.total[h]) == doctest::Approx(expected).epsilon(0.01));
      CHECK(std::abs(double(below.total[h]) - expected) <
            4.5 * std::hypot(double(below.error[h]), 0.002 * expected));
    }
  }
}

// A surface of a fabric that is all threads has the fabric's figures.
TEST_CASE("threads scatter what holes do not pass") {
  const Material m = material_of({"screen", 0.04, 0.14, 0.48});
  CHECK(m.alpha.value == doctest::Approx(0.96));
  CHECK(m.base_color.value.g == doctest::Approx(0.5));
  CHECK(m.diffuse_transmission.value == doctest::Approx(0.10 / 0.96));
  CHECK(!material_of({"opaque", 0, 0, 0.5}).is_alpha_masked);
  CHECK(fault_of({"a", 0.1, 0.05, 0}).find("above its transmittance") != std::string::npos);
  CHECK(fault_of({"a", 0, 0.6, 0.5}).find("more light") != std::string::npos);
  CHECK(!fault_of({"a", 1, 1, 0}).empty());
  CHECK(!fault_of({"a", -0.1, 0, 0}).empty());
  CHECK(fault_of({"a", 0.1, 0.5, 0.5}).empty());
}

TEST_CASE("mistakes about fabrics are named") {
  const auto with = [](const std::string& state, const std::string& fabric) {
    return message_for(R"({"fabrics":[)" + fabric +
                       R"(],"groups":[{"name":"g","windows":["w"],"states":[)" + state + "]}]}");
  };
  const auto has = [](const std::string& text, const std::string& part) {
    CAPTURE(text);
    return text.find(part) != std::string::npos;
  };
  const std::string good = R"({"name":"f","openness":0.03,"transmittance":0.1,"reflectance":0.4})";
  CHECK(with(R"({"shown":["s"],"fabric":"f"})", good).empty());
  CHECK(has(with(R"({"shown":["s"],"fabric":"g"})", good), "none of the \"fabrics\""));
  CHECK(has(with(R"({"fabric":"f"})", good), "names no \"shown\" nodes"));
  CHECK(has(with("{}", R"({"name":"f","openness":0.3})"), "above its transmittance"));
  CHECK(has(with("{}", R"({"openness":0})"), "name"));
}
