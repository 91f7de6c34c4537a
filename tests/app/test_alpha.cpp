// Sheets with alpha in front of lights, by every method and from every format: the share 1 - alpha
// of the light arrives, for any light. Light from a point always takes the same path to a measuring
// point, so a random decision per ray would give all or nothing.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/units.h"
#include "daylit_rooms.h"
#include "program.h"

using namespace troffer;
using namespace troffer::test;

namespace test_alpha {

namespace {

constexpr double alpha = 0.3;

const char* const points = "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n.4,.3,0,0,0,1\n-.8,.6,0,0,0,1\n";
constexpr double squared_distances[] = {0, 0.25, 1};  // from the origin

// A black sheet, 200 m wide, at a given height.
std::string pbrt_sheet(double height, const std::string& sheet_alpha) {
  return fmt::format(
      "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n"
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] "
      "\"point3 P\" [-100 -100 {0} 100 -100 {0} 100 100 {0} -100 100 {0}] "
      "\"point2 uv\" [0 0 1 0 1 1 0 1] {1}\n",
      height, sheet_alpha);
}
std::string constant(double a) {
  return fmt::format("\"float alpha\" [{}]", a);
}
const std::string floor_below = pbrt_sheet(-1, "");

std::vector<Measured> measure(const std::string& name, const std::string& text,
                              const std::vector<std::string>& options) {
  const Folder folder;
  std::vector<std::string> words{"measure", folder.write(name, text), "--points",
                                 folder.write("p.csv", points)};
  words.insert(words.end(), options.begin(), options.end());
  const Finished f = run_program(folder, words);
  CAPTURE(f.err);
  REQUIRE(f.status == 0);
  return measured(f);
}

struct Light {
  const char* name;
  std::string text;
  double (*irradiance)(double squared_distance);  // below it, at a squared distance from the axis
  bool is_alike = true;                           // all its light takes one path to a point
};

// Returns I h / d³ below a point light at height h.
double below_point(double r2) {
  return 7 * 2 / std::pow(r2 + 4, 1.5);
}

const Light lights[] = {
    {"point", "LightSource \"point\" \"rgb I\" [7 7 7] \"point3 from\" [0 0 2]\n", below_point},
    {"spot",
     "LightSource \"spot\" \"rgb I\" [7 7 7] \"point3 from\" [0 0 2] \"point3 to\" [0 0 0] "
     "\"float coneangle\" [80] \"float conedeltaangle\" [1]\n",
     below_point},
    {"distant",
     "LightSource \"distant\" \"rgb L\" [3 3 3] \"point3 from\" [0 0 1] \"point3 to\" [0 0 0]\n",
     [](double) { return 3.0; }},
    {"surroundings", "LightSource \"infinite\" \"rgb L\" [2 2 2]\n", [](double) { return 2 * pi; },
     false},
};

void check_measured(const std::vector<Measured>& values, const Light& light, double share) {
  REQUIRE(values.size() == 3);
  for (size_t i = 0; i < values.size(); ++i) {
    const double expected = luminous_efficacy * share * light.irradiance(squared_distances[i]);
    CAPTURE(i);
    CAPTURE(values[i].lx);
    CAPTURE(expected);
    // Beyond the rim of the sheet of 200 m some surroundings are visible.
    CHECK(std::abs(values[i].lx - expected) <
          (light.is_alike ? 2e-4 : 2e-3) * expected + 5 * values[i].error);
    if (light.is_alike) CHECK(values[i].error < 1e-3 * expected);
  }
}

}  // namespace

TEST_CASE("a sheet of alpha .3 leaves .7 of a light, two of them .49, by every method") {
  const std::vector<std::vector<std::string>> methods{
      {"--method", "certified"},
      {"--method", "certified", "--indirect", "none"},
      {"--method", "path", "--spp", "2048"},
      {"--method", "fixed"},
      {"--method", "kj92"}};
  for (const Light& light : lights)
    for (const int sheets : {1, 2})
      for (const auto& method : methods) {
        CAPTURE(light.name);
        CAPTURE(sheets);
        CAPTURE(fmt::format("{}", fmt::join(method, " ")));
        const std::string world = "WorldBegin\n" + floor_below + pbrt_sheet(1, constant(alpha)) +
                                  (sheets == 2 ? pbrt_sheet(1.5, constant(alpha)) : "") +
                                  light.text;
        check_measured(measure("s.pbrt", world, method), light, std::pow(1 - alpha, sheets));
      }
}

TEST_CASE("alpha by a texture: its share where it blends, nothing where it is 1") {
  // A checkerboard of alpha .3 and 1 across 200 m: the quarter at the origin blends, its neighbours
  // are opaque.
  const std::string texture =
      "Texture \"holes\" \"float\" \"checkerboard\" \"float uscale\" [2] \"float vscale\" [1] "
      "\"float tex1\" [.3] \"float tex2\" [1]\n";
  const Folder folder;
  const std::string world = "WorldBegin\n" + texture + floor_below +
                            pbrt_sheet(1, "\"texture alpha\" \"holes\"") + lights[2].text;
  const std::string list = folder.write("p.csv", "x,y,z,nx,ny,nz\n-50,0,0,0,0,1\n50,0,0,0,0,1\n");
  for (const std::string method : {"certified", "path", "fixed"}) {
    CAPTURE(method);
    const Finished f = run_program(
        folder, {"measure", folder.write("s.pbrt", world), "--points", list, "--method", method});
    REQUIRE(f.status == 0);
    const std::vector<Measured> values = measured(f);
    REQUIRE(values.size() == 2);
    const double blended = std::max(values[0].lx, values[1].lx);
    CHECK(blended == doctest::Approx(0.7 * 3 * luminous_efficacy).epsilon(1e-4));
    CHECK(std::min(values[0].lx, values[1].lx) == 0);
  }
}

TEST_CASE("masks of other formats leave the same share") {
  const std::string mitsuba =
      "<scene version='3.0.0'><integrator type='path'/>"
      "<emitter type='point'><point name='position' x='0' y='0' z='2'/>"
      "<rgb name='intensity' value='7'/></emitter>"
      "<shape type='rectangle'><transform name='to_world'><scale value='100'/>"
      "<translate x='0' y='0' z='1'/></transform><bsdf type='mask'>"
      "<float name='opacity' value='0.3'/><bsdf type='twosided'><bsdf type='diffuse'>"
      "<rgb name='reflectance' value='0'/></bsdf></bsdf></bsdf></shape></scene>";
  check_measured(measure("s.xml", mitsuba, {}), lights[0], 1 - alpha);
}

}  // namespace test_alpha
