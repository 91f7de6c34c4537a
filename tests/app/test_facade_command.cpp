// Façades from the command line: matrices of glazing against closed forms by every method, sensor
// grids of Honeybee models, and glare of a view.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/units.h"
#include "program.h"
#include "support/hbjson_room.h"
#include "support/klems.h"

using namespace troffer;
using namespace troffer::test;

namespace test_facade_command {

namespace {

constexpr double diffuse = 0.2, straight = 0.5;

AngleMatrix glazing() {
  return peaked_matrix(klems_full(), diffuse, straight);
}

// A black floor below a layer 1 km wide, whose front looks down.
std::string layered(const std::string& material, const std::string& light) {
  return "void plastic black 0 0 5 0 0 0 0 0\n" + material +
         "black polygon floor 0 0 12 -600 -600 0  600 -600 0  600 600 0  -600 600 0\n"
         "layer polygon roof 0 0 12 -500 -500 1  -500 500 1  500 500 1  500 -500 1\n" +
         light;
}
const char* const sky = "void glow even 0 0 4 1 1 1 0\neven source s 0 0 4 0 0 1 360\n";
const char* const sharp = "void aBSDF layer 5 w.xml 0 1 0 . 0 0\n";
const char* const wide = "void BSDF layer 6 0 w.xml 0 1 0 . 0 0\n";
const char* const point = "x,y,z,nx,ny,nz\n.3,.1,0.01,0,0,1\n";

Measured measure_one(const std::string& scene, const std::vector<std::string>& options) {
  const Folder folder;
  folder.write("w.xml", klems_file({{"Transmission Front", glazing()}}));
  std::vector<std::string> words{"measure", folder.write("s.rad", scene), "--points",
                                 folder.write("p.csv", point), "--quiet"};
  words.insert(words.end(), options.begin(), options.end());
  const Finished f = run_program(folder, words);
  CAPTURE(f.err);
  REQUIRE(f.status == 0);
  return measured(f).at(0);
}

const std::vector<std::vector<std::string>> methods{{"--method", "path", "--spp", "65536"},
                                                    {"--method", "certified", "--error", "0.005"}};

void check(const Measured& m, double expected) {
  CAPTURE(m.lx);
  CAPTURE(m.error);
  CHECK(m.error < 0.02 * expected);
  CHECK(std::abs(m.lx - expected) < 4 * m.error + 0.002 * expected);
}

}  // namespace

// Σ_o Σ_i M Ω_o Ω_i at 179 lm/W, whether the straight light is kept sharp or not.
TEST_CASE("a sensor behind matrices under an even sky sees their double sum") {
  const double expected = 179 * sky_through(glazing());
  for (const auto& method : methods)
    for (const char* const material : {sharp, wide}) {
      CAPTURE(method[1]);
      CAPTURE(material);
      check(measure_one(layered(material, sky), method), expected);
    }
}

// Sunlight of 1 W/m² per unit of cosine from θ = 40°, in the ring from 35° to 45°. It passes the
// share straight × cos of the patch's middle as a beam, and diffuse evenly. All that passes falls
// onto the floor, since the layer is as wide as the sky.
TEST_CASE("a sensor behind matrices in the sun receives what its patch passes") {
  const double theta = rad_from_deg(40.0), half = rad_from_deg(0.25);
  const double radiance = 1 / (pi * std::sin(half) * std::sin(half));
  const std::string sun =
      fmt::format("void light beam 0 0 3 {0} {0} {0}\nbeam source s 0 0 4 {1} 0 {2} 0.5\n",
                  radiance, std::sin(theta), std::cos(theta));
  const AngleBasis basis = klems_full();
  const double middle =
      double(basis.direction(basis.patch_of({0.643f, 0, 0.766f}), {0.5f, 0.5f}).z);
  const double expected = 179 * std::cos(theta) * (diffuse + straight * middle);
  for (const auto& method : methods) {
    CAPTURE(method[1]);
    check(measure_one(layered(sharp, sun), method), expected);
    check(measure_one(layered(wide, sun), method), expected);
  }
}

TEST_CASE("measure uses the sensor grids of a model, all or by name or room") {
  const Folder folder;
  const std::string model = folder.write("m.hbjson", HbjsonRoom().text());
  const std::vector<std::string> light{"--sky", "overcast", "--method", "path", "--spp", "64"};
  const auto lines = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"measure", model});
    words.insert(words.end(), light.begin(), light.end());
    const Finished f = run_program(folder, words);
    CAPTURE(f.err);
    REQUIRE(f.status == 0);
    return std::pair(std::count(f.out.begin(), f.out.end(), '\n'), f.out);
  };
  const auto [all, text] = lines({});
  CHECK(all == 3);
  CHECK(text.find("2,1,0.8,0,0,1,") != std::string::npos);
  CHECK(text.find(",desk\n") != std::string::npos);
  CHECK(lines({"--grid", "desk"}).second == text);
  CHECK(lines({"--grid", "room_1"}).second == text);
  // The room's floor, as of any node: more points than sensors.
  CHECK(lines({"--grid", "Office,0.8"}).first > 3);
  const Finished none =
      run_program(folder, {"measure", model, "--sky", "overcast", "--grid", "nowhere"});
  CHECK(none.status == 2);
  const Finished state = run_program(folder, {"measure", model, "--state", "South=1"});
  CHECK(state.status == 2);
  CHECK(state.err.find("no group 'South'") != std::string::npos);
}

// An eye in a black void before a square of 1 × 1 m, 2 m away, of luminance 10 000 cd/m²:
// DGP = 5.87e-5 Ev + .092 log10(1 + L² ω / (Ev^1.87 P²)) + .159, with P = 1 on the line of sight.
TEST_CASE("glare rates a view of a bright square") {
  const Folder folder;
  const double l = 10000;
  const std::string scene = fmt::format(
      "void light bright 0 0 3 {0} {0} {0}\n"
      "bright polygon p 0 0 12 2 -.5 -.5  2 -.5 .5  2 .5 .5  2 .5 -.5\n",
      l / 179);
  const Finished f = run_program(
      folder, {"glare", folder.write("s.rad", scene), "--eye", "0,0,0", "--target", "1,0,0",
               "--width", "400", "--json", "--quiet", "-o", folder.path("view.hdr")});
  CAPTURE(f.err);
  REQUIRE(f.status == 0);
  const nlohmann::json j = nlohmann::json::parse(f.out);
  // A square of half width a at distance d: ω = 4 asin(a² / (a² + d²)).
  const double omega = 4 * std::asin(0.25 / 4.25);
  // Form factor of a parallel square: 4 × (2/2π) X/√(1+X²) atan(X/√(1+X²)), X = a/d, times π L.
  const double x = 0.25, s = std::sqrt(1 + x * x);
  const double ev = l * 4 * x / s * std::atan(x / s);
  CHECK(j["vertical_illuminance_lx"].get<double>() == doctest::Approx(ev).epsilon(0.005));
  REQUIRE(j["sources"].size() == 1);
  CHECK(j["sources"][0]["solid_angle"].get<double>() == doctest::Approx(omega).epsilon(0.05));
  CHECK(j["sources"][0]["luminance"].get<double>() == doctest::Approx(l).epsilon(0.05));
  CHECK(j["sources"][0]["position_index"].get<double>() == doctest::Approx(1).epsilon(0.02));
  const double dgp =
      5.87e-5 * ev + 0.092 * std::log10(1 + l * l * omega / std::pow(ev, 1.87)) + 0.159;
  CHECK(j["dgp"].get<double>() == doctest::Approx(dgp).epsilon(0.005));
  // The picture that was written is rated alike, within the 8 bits of its mantissas.
  const Finished again = run_program(folder, {"glare", folder.path("view.hdr"), "--json"});
  REQUIRE(again.status == 0);
  CHECK(nlohmann::json::parse(again.out)["dgp"].get<double>() ==
        doctest::Approx(dgp).epsilon(0.01));
  const Finished text = run_program(folder, {"glare", folder.path("view.hdr")});
  CHECK(text.out.starts_with("DGP "));
  CHECK(run_program(folder, {"glare", folder.path("s.rad"), "--quiet"}).status == 2);
}

// Scenes of glTF are photometric. Their pictures are written in W/(m² sr) all the same.
TEST_CASE("the written picture of a photometric scene is rated as the view is") {
  const Folder folder;
  const std::string office = std::string(TROFFER_SOURCE_DIR) + "/scenes/year-office/office.glb";
  const Finished live =
      run_program(folder, {"glare", office, "--eye", "3,1.2,-4", "--target", "3,1.2,0", "--width",
                           "96", "--json", "--quiet", "-o", folder.path("office.hdr")});
  REQUIRE(live.status == 0);
  const Finished file = run_program(folder, {"glare", folder.path("office.hdr"), "--json"});
  REQUIRE(file.status == 0);
  for (const char* figure : {"dgp", "vertical_illuminance_lx"})
    CHECK(nlohmann::json::parse(file.out)[figure].get<double>() ==
          doctest::Approx(nlohmann::json::parse(live.out)[figure].get<double>()).epsilon(0.01));
}

}  // namespace test_facade_command
