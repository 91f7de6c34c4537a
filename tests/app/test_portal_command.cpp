// Portals (--portal): rectangles through which light from outside enters, and their accuracy.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cmath>

#include "program.h"

using namespace troffer;
using namespace troffer::test;

namespace test_portal_command {

namespace {

const char* const points =
    "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n1.2,.4,.3,0,0,1\n-2,1,.5,0,0,1\n.3,-.2,1.6,0,0,1\n"
    "2,0,1,-1,0,0\n";
const char* const plain =
    "WorldBegin\nShape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" "
    "[-4 -4 -.1  4 -4 -.1  4 4 -.1  -4 4 -.1]\n";
// A rectangle in mid-air; outside is above.
const char* const corners = "-.5 -.8 2  .5 -.8 2  .5 .8 2  -.5 .8 2";

std::string with_commas(std::string s) {
  std::string out;
  for (const char c : s)
    if (c != ' ')
      out += c;
    else if (!out.empty() && out.back() != ',')
      out += ',';
  return out;
}

}  // namespace

TEST_CASE("uniform light through a portal in mid-air equals an emitting panel there") {
  const Folder folder;
  const std::string at = folder.write("p.csv", points);
  const std::string turned = "-.5 -.8 2  -.5 .8 2  .5 .8 2  .5 -.8 2";
  const auto panel = measure_direct(
      folder,
      folder.write("panel.pbrt",
                   std::string(plain) +
                       "AreaLightSource \"diffuse\" \"rgb L\" [3 3 3]\nShape \"trianglemesh\" "
                       "\"integer indices\" [0 1 2 0 2 3] \"point3 P\" [" +
                       turned + "]\n"),
      at, {});
  const std::string open = folder.write(
      "open.pbrt", std::string(plain) + "LightSource \"infinite\" \"rgb L\" [3 3 3]\n");
  const std::string with =
      folder.write("with.pbrt", std::string(plain) +
                                    "LightSource \"infinite\" \"rgb L\" [3 3 3] \"point3 "
                                    "portal\" [" +
                                    turned + "]\n");
  const auto in_file = measure_direct(folder, with, at, {});
  const auto by_option = measure_direct(folder, open, at, {"--portal", with_commas(turned)});
  const auto wrong_way = measure_direct(folder, open, at, {"--portal", with_commas(corners)});
  for (size_t i = 0; i < panel.size(); ++i) {
    CAPTURE(i);
    CHECK(panel[i].lx > 0);
    CHECK(std::abs(in_file[i].lx - panel[i].lx) < 5 * in_file[i].error + 1e-3 * panel[i].lx);
    CHECK(in_file[i].error < 2e-3 * panel[i].lx);
    CHECK(by_option[i].lx == in_file[i].lx);
    CHECK(wrong_way[i].lx == 0);
  }
}

TEST_CASE("--portal: names of rectangles, names of other nodes, and lights without a portal") {
  const Folder folder;
  const std::string at = folder.write("p.csv", points);
  const char* const gltf =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],"nodes":[{"name":"opening",)"
      R"("mesh":0,"translation":[0,2,0]},{"name":"floor","mesh":0,"translation":[0,-1,0],)"
      R"("rotation":[1,0,0,0],"scale":[8,8,8]}],"meshes":[{"primitives":[{"attributes":)"
      R"({"POSITION":0},"indices":1}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":4,)"
      R"("type":"VEC3","min":[-0.5,0,-0.5],"max":[0.5,0,0.5]},{"bufferView":1,"componentType":5123,)"
      R"("count":6,"type":"SCALAR"}],"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,)"
      R"("byteOffset":48,"byteLength":12}],"buffers":[{"byteLength":60,"uri":"rectangle.bin"}]})";
  std::string bytes;
  for (const float v : {-.5f, 0.f, -.5f, .5f, 0.f, -.5f, .5f, 0.f, .5f, -.5f, 0.f, .5f})
    bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
  for (const uint16_t v : {0, 1, 2, 0, 2, 3}) bytes.append(reinterpret_cast<const char*>(&v), 2);
  folder.write("rectangle.bin", bytes);
  const std::string scene = folder.write("s.gltf", gltf);
  const std::string below = folder.write("b.csv", "x,y,z,nx,ny,nz\n0,0,0,0,1,0\n1,1,.5,0,1,0\n");
  const auto lit = [&](const std::vector<std::string>& options) {
    return measure_direct(folder, scene, below, options);
  };
  // The floor is the same mesh, with its front upward; the opening's front looks down.
  const auto by_name = lit({"--sky", "overcast", "--portal", "opening"});
  const auto by_corners =
      lit({"--sky", "overcast", "--portal", "-.5,2,-.5,.5,2,-.5,.5,2,.5,-.5,2,.5"});
  const auto paths = lit({"--sky", "overcast", "--portal", "opening", "--method", "path", "--depth",
                          "1", "--spp", "16384"});
  for (size_t i = 0; i < 2; ++i) {
    CAPTURE(i);
    CHECK(by_name[i].lx > 100);
    CHECK(std::abs(by_name[i].lx - paths[i].lx) <
          5 * (paths[i].error + by_name[i].error) + 2e-3 * paths[i].lx);
  }
  // With corners alone the opening's mesh is still there and blocks the light.
  CHECK(by_corners[0].lx < 1e-3 * by_name[0].lx);
  const auto status = [&](const std::string& portal) {
    return run_program(folder, {"measure", scene, "--points", below, "--portal", portal,
                                "--indirect", "none", "--sky", "even"})
        .status;
  };
  CHECK(status("floor") == 0);
  for (const char* bad : {"door", "1,2,3", "0,0,0,1,0,0,1,1,0,0,1,1", "0,0,0,1,0,0,1,1,0,0,1,nan",
                          "0,0,0,0,0,0,0,0,0,0,0,0", "0,0,0,1,0,0,1,1,0,0,1,0,5,5,5"}) {
    CAPTURE(bad);
    CHECK(status(bad) == 2);
  }
  const Finished f = run_program(
      folder, {"measure", scene, "--points", below, "--portal", "opening", "--sky", "none"});
  CHECK(f.err.find("--portal does nothing") != std::string::npos);
}

TEST_CASE("several portals each let in their own light, none twice") {
  const Folder folder;
  const std::string at = folder.write("p.csv", points);
  const std::string open = folder.write(
      "open.pbrt", std::string(plain) + "LightSource \"infinite\" \"rgb L\" [3 3 3]\n");
  const std::string left = "-.5,-.8,2,-.5,.8,2,0,.8,2,0,-.8,2",
                    right = "0,-.8,2,0,.8,2,.5,.8,2,.5,-.8,2",
                    whole = "-.5,-.8,2,-.5,.8,2,.5,.8,2,.5,-.8,2",
                    above = "-.5,-.8,3,-.5,.8,3,.5,.8,3,.5,-.8,3";
  for (const char* method : {"certified", "path", "fixed"}) {
    const auto lit = [&](const std::vector<std::string>& portals) {
      std::vector<std::string> options{"--method", method};
      for (const std::string& p : portals) options.insert(options.end(), {"--portal", p});
      return measure_direct(folder, open, at, options);
    };
    const auto both = lit({left, right}), one = lit({whole});
    for (size_t i = 0; i < one.size(); ++i) {
      CAPTURE(method);
      CAPTURE(i);
      CHECK(one[i].lx > 0);
      CHECK(std::abs(both[i].lx - one[i].lx) <
            5 * (both[i].error + one[i].error) + 2e-3 * one[i].lx);
    }
  }
  const auto run = [&](const std::string& a, const std::string& b) {
    return run_program(folder, {"measure", open, "--points", at, "--portal", a, "--portal", b,
                                "--indirect", "none", "--spp", "16"});
  };
  const Finished overlapping = run(whole, left), beyond = run(whole, above),
                 beside = run(left, right);
  CHECK(overlapping.status == 2);
  CHECK(overlapping.err.find("overlap") != std::string::npos);
  CHECK(beyond.err.find("counts twice") != std::string::npos);
  CHECK(beside.err.find("counts twice") == std::string::npos);
  CHECK(run(whole, "1,2,3").status == 2);
  // Blinds outside of a portal reflect none of its light, so the program warns of them.
  const auto is_told = [&](double height) {
    const std::string scene = folder.write(
        "slats.pbrt", std::string(plain) +
                          "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point3 P\" [" +
                          fmt::format("-.5 0 {0}  .5 0 {0}  .5 .1 {0}]\n", height) +
                          "LightSource \"infinite\" \"rgb L\" [3 3 3]\n");
    return run_program(folder, {"measure", scene, "--points", at, "--portal", whole, "--indirect",
                                "none", "--spp", "16"})
               .err.find("1 triangles lie outside") != std::string::npos;
  };
  CHECK(is_told(2.1));
  CHECK(!is_told(1.9));
}

}  // namespace test_portal_command
