// Lights by name: wildcards of --luminaire and --dim, grids over a node, and emission of surfaces.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/units.h"
#include "program.h"

using namespace troffer;
using namespace troffer::test;

namespace test_light_by_name {

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != text.npos;
}

const char* const point_ies =
    "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 40\n0 90\n0\n100 100\n";

// Point lights of 10, 20 and 30 cd, 2 m above a floor of 4 × 2 m (y up), named lamp.1, lamp.2 and
// spare; and a panel of half a square metre with 5 cd/m².
std::string gltf() {
  std::string lights, nodes;
  int n = 0;
  for (const auto& [name, candela] : {std::pair{"lamp.1", 10}, {"lamp.2", 20}, {"spare", 30}}) {
    nodes += fmt::format(
        ",{{\"name\":\"{}\",\"translation\":[{},2,1],\"extensions\":{{\"KHR_lights_punctual\":"
        "{{\"light\":{}}}}}}}",
        name, 1 + n, n);
    lights += fmt::format("{}{{\"type\":\"point\",\"intensity\":{}}}", n++ > 0 ? "," : "", candela);
  }
  // Corners of the floor as floats: 0,0,0 and 4,0,0 and 0,0,2 and 4,0,2.
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1,2,3,4]}],
"extensionsUsed":["KHR_lights_punctual"],"extensions":{"KHR_lights_punctual":{"lights":[)" +
         lights + R"(]}},"nodes":[{"mesh":0,"name":"floor"})" + nodes +
         R"(,{"mesh":1,"name":"panel","translation":[0,3,0],"scale":[0.25,1,0.25]}],
"materials":[{},{"emissiveFactor":[1,1,1],"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":5}}}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]},
{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":1}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[4,0,2]},
{"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12}],
"buffers":[{"byteLength":60,"uri":"data:application/octet-stream;base64,)"
         "AAAAAAAAAAAAAAAAAACAQAAAAAAAAAAAAAAAAAAAAAAAAABAAACAQAAAAAAAAABAAAACAAEAAQACAAMA\"}]}";
}

struct NamesTest {
  Folder folder;
  std::string scene = folder.write("lamps.gltf", gltf());
  std::string lamp = folder.write("lamp.ies", point_ies);
  // One point below each lamp.
  std::string points =
      folder.write("p.csv", "x,y,z,nx,ny,nz\n1,0,1,0,1,0\n2,0,1,0,1,0\n3,0,1,0,1,0\n");

  Finished run(const std::vector<std::string>& more) {
    std::vector<std::string> words{"measure", scene, "--points", points, "--indirect", "none"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(folder, words);
  }
  // Measures with the named lights alone.
  std::vector<Measured> lx(const std::string& light, const std::vector<std::string>& more) {
    std::vector<std::string> words = more;
    words.insert(words.end(), {"--light", light});
    const Finished f = run(words);
    CAPTURE(f.err);
    REQUIRE(f.status == 0);
    return measured(f);
  }
};

}  // namespace

TEST_CASE("--luminaire accepts a wildcard: each matching light uses the file") {
  NamesTest t;
  const std::vector<std::string> all{"--luminaire", "lamp.*=" + t.lamp};
  CHECK(t.lx("lamp.1", all)[0].lx == doctest::Approx(100 / 4.0).epsilon(1e-4));
  CHECK(t.lx("lamp.2", all)[1].lx == doctest::Approx(100 / 4.0).epsilon(1e-4));
  CHECK(t.lx("spare", all)[2].lx == doctest::Approx(30 / 4.0).epsilon(1e-4));
  for (const char* pattern : {"*.1", "lamp*1", "l*p.*1"})
    CHECK(t.lx("lamp.1", {"--luminaire", std::string(pattern) + "=" + t.lamp})[0].lx ==
          doctest::Approx(100 / 4.0).epsilon(1e-4));
  const Finished none = t.run({"--luminaire", "desk*=" + t.lamp});
  CHECK(none.status == 2);
  CHECK(contains(none.err, "no name matches 'desk*'"));
  // Surfaces that do not emit yet.
  CHECK(t.run({"--luminaire", "flo*=" + t.lamp}).status == 0);
}

TEST_CASE("--dim scales the light of the named sources") {
  NamesTest t;
  const double whole = t.lx("lamp.1", {})[0].lx;
  CHECK(whole == doctest::Approx(10 / 4.0).epsilon(1e-4));
  CHECK(t.lx("lamp.1", {"--dim", "lamp.1=.25"})[0].lx == doctest::Approx(whole / 4).epsilon(1e-5));
  CHECK(t.lx("lamp.1", {"--dim", "lamp*=2"})[0].lx == doctest::Approx(2 * whole).epsilon(1e-5));
  CHECK(t.lx("lamp.1", {"--dim", "lamp.2=2"})[0].lx == doctest::Approx(whole));
  // The last of several requests counts.
  CHECK(t.lx("lamp.1", {"--dim", "lamp*=2", "--dim", "lamp.1=3"})[0].lx ==
        doctest::Approx(3 * whole).epsilon(1e-5));
  // Lights that are off, by every method.
  for (const char* method : {"certified", "path", "fixed", "kj92"}) {
    const Finished f = t.run({"--dim", "lamp.2=0", "--dim", "spare=0", "--dim", "panel=0",
                              "--method", method, "--spp", "64"});
    CAPTURE(method);
    CAPTURE(f.err);
    REQUIRE(f.status == 0);
    CHECK(measured(f)[0].lx == doctest::Approx(whole).epsilon(0.01));
  }
  // Daylight and measured luminaires can be dimmed, too.
  const double sky = t.lx("sky", {"--sky", "even,1000"})[0].lx;
  CHECK(t.lx("sky", {"--sky", "even,1000", "--dim", "sky=.1"})[0].lx ==
        doctest::Approx(sky / 10).epsilon(1e-4));
  CHECK(t.lx("lamp.1", {"--luminaire", "lamp*=" + t.lamp, "--dim", "lamp*=.5"})[0].lx ==
        doctest::Approx(100 / 8.0).epsilon(1e-4));
  for (const char* bad :
       {"lamp.1", "lamp.1=", "=2", "lamp.1=-1", "lamp.1=x", "lamp.1=nan", "desk=1"})
    CHECK(t.run({"--dim", bad}).status == 2);
}

TEST_CASE("--dim scales the power in a report") {
  NamesTest t;
  const auto watts = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"report",
                                   t.scene,
                                   "-o",
                                   t.folder.path("r"),
                                   "--pictures",
                                   "off",
                                   "--cylindrical",
                                   "off",
                                   "--spp",
                                   "16",
                                   "--luminaire",
                                   "lamp*=" + t.lamp,
                                   "--power",
                                   "spare=60",
                                   "--power",
                                   "panel=0"};
    words.insert(words.end(), more.begin(), more.end());
    const Finished f = run_program(t.folder, words);
    CAPTURE(f.err);
    REQUIRE(f.status == 0);
    return nlohmann::json::parse(read_file(t.folder.path("r/report.json")))["power"]["watts"]
        .get<double>();
  };
  CHECK(watts({}) == doctest::Approx(40 + 40 + 60));
  CHECK(watts({"--dim", "lamp*=.5"}) == doctest::Approx(20 + 20 + 60));
  CHECK(watts({"--dim", "spare=.1", "--dim", "lamp.2=.5"}) == doctest::Approx(40 + 20 + 6));
}

TEST_CASE("--grid lays points over a node's upward surface") {
  NamesTest t;
  const auto rows = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"measure", t.scene, "--indirect", "none", "--spp", "16"};
    words.insert(words.end(), more.begin(), more.end());
    const Finished f = run_program(t.folder, words);
    CAPTURE(f.err);
    REQUIRE(f.status == 0);
    std::vector<std::array<double, 6>> points;
    std::istringstream in(f.out);
    std::string line;
    std::getline(in, line);
    CHECK(line.ends_with(",surface"));
    while (std::getline(in, line)) {
      std::array<double, 6> p{};
      REQUIRE(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf", &p[0], &p[1], &p[2], &p[3],
                          &p[4], &p[5]) == 6);
      CHECK(line.ends_with(",floor"));
      points.push_back(p);
    }
    return points;
  };
  // Half a metre apart: 8 × 4 cells of the floor of 4 × 2 m.
  const auto half = rows({"--grid", "floor,0.75,0.5"});
  REQUIRE(half.size() == 32);
  for (const auto& p : half) {
    CHECK(p[1] == doctest::Approx(0.75));
    CHECK(std::abs(std::remainder(p[0] - 0.25, 0.5)) < 1e-6);
    CHECK(std::abs(std::remainder(p[2] - 0.25, 0.5)) < 1e-6);
    CHECK(p[4] == doctest::Approx(1));
  }
  // EN 12464-1, 4.4: the longer side is twice the shorter one, so d = 2 m and p = .2 * 5^lg 2 =
  // .325 m: seven cells along d, fourteen along the other side.
  CHECK(rows({"--grid", "floor"}).size() == 98);
  CHECK(rows({"--grid", "floor"})[0][1] == doctest::Approx(0));
  for (const auto& p : rows({"--grid", "floor,0.75,0.5", "--border", "0.5"})) {
    CHECK(p[0] > 0.5);
    CHECK(p[0] < 3.5);
    CHECK(p[2] > 0.5);
    CHECK(p[2] < 1.5);
  }
  // Together with a list, whose points come first.
  const Finished both = run_program(
      t.folder, {"measure", t.scene, "--indirect", "none", "--spp", "16", "--points",
                 t.folder.write("n.csv", "x,y,z,nx,ny,nz\n1,0,1,0,1,0\n"), "--grid", "floor,0,2"});
  REQUIRE(both.status == 0);
  CHECK(contains(both.out, "standard_error,surface\n1,0,1,"));
  CHECK(contains(both.out, ",floor\n"));
  for (const char* bad : {"desk", "", ",1", "floor,1e5", "floor,0,0", "floor,0,-1", "floor,0,1e-5"})
    CHECK(run_program(t.folder, {"measure", t.scene, "--grid", bad}).status == 2);
  CHECK(run_program(t.folder, {"measure", t.scene}).status == 2);
}

// glTF-Blender-IO writes emission strength without a factor, and lamps with 683 lm/W.
TEST_CASE("surfaces that are dim beside lamps cause a warning, and --emission-scale scales them") {
  NamesTest t;
  // The lamps emit 4 π (10 + 20 + 30) = 754 lm, the panel of .5 m² with 5 cd/m² 7.9 lm to one side.
  CHECK_FALSE(contains(t.run({}).err, "--emission-scale"));  // more than a hundredth of the lamps
  std::string strong = gltf();
  strong.replace(strong.find("\"intensity\":30"), 14, "\"intensity\":3000");
  const std::string scene = t.folder.write("strong.gltf", strong);
  const auto measure = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"measure", scene, "--points", t.points, "--indirect", "none"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(t.folder, words);
  };
  CHECK(contains(measure({}).err, "Blender exports emission without the factor 683"));
  CHECK_FALSE(contains(measure({"--emission-scale", "683"}).err, "--emission-scale"));
  const auto info = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"info", scene, "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const Finished f = run_program(t.folder, words);
    REQUIRE(f.status == 0);
    std::map<std::string, double> power;
    const auto json = nlohmann::json::parse(f.out);
    for (const auto& s : json["sources"])
      power[s["name"].get<std::string>()] += s["power"].get<double>();
    return power;
  };
  const auto as_is = info({}), scaled = info({"--emission-scale", "683"});
  CHECK(as_is.at("panel") == doctest::Approx(pi * 5 * 0.5).epsilon(1e-4));
  CHECK(scaled.at("panel") == doctest::Approx(683 * as_is.at("panel")).epsilon(1e-4));
  CHECK(scaled.at("spare") == doctest::Approx(as_is.at("spare")));
  for (const char* bad : {"-1", "x", "1e12"}) CHECK(measure({"--emission-scale", bad}).status == 2);
}

}  // namespace test_light_by_name
