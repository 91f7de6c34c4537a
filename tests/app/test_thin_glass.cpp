// Panes as files describe them: thin boxes of solid glass, glTF's transmission, OBJ's dissolve.
// They transmit by Fresnel's equations like thin sheets, and their reflections show no noise.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "base/units.h"
#include "daylit_rooms.h"
#include "image/read_image.h"
#include "program.h"
#include "support/quadrature.h"

using namespace troffer;
using namespace troffer::test;

namespace test_thin_glass {

namespace {

const char* const black_floor =
    "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n"
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] "
    "\"point3 P\" [-50 -50 0  50 -50 0  50 50 0  -50 50 0]\n";

// A closed box of glass, 1 km by 1 km, between two heights.
std::string glass_box(double from, double to) {
  return fmt::format(
      "Material \"dielectric\" \"float eta\" 1.5\n"
      "Shape \"trianglemesh\" \"integer indices\" [0 2 1 0 3 2  4 5 6 4 6 7  0 1 5 0 5 4  "
      "1 2 6 1 6 5  2 3 7 2 7 6  3 0 4 3 4 7] \"point3 P\" "
      "[-500 -500 {0}  500 -500 {0}  500 500 {0}  -500 500 {0}  "
      "-500 -500 {1}  500 -500 {1}  500 500 {1}  -500 500 {1}]\n",
      from, to);
}

std::vector<Measured> measure(const Folder& folder, const std::string& scene, const char* points,
                              const std::vector<std::string>& options) {
  std::vector<std::string> words{"measure", scene, "--points", folder.write("p.csv", points)};
  words.insert(words.end(), options.begin(), options.end());
  const Finished f = run_program(folder, words);
  CAPTURE(f.err);
  REQUIRE(f.status == 0);
  return measured(f);
}

// Illuminance through several panes under a uniform sky of 10 000 lx.
double under_sky(int panes) {
  return 2e4 * integrate([&](double c) { return c * std::pow(pane_transmittance(c), panes); }, 0.0,
                         1.0, 100);
}

void check(const std::vector<Measured>& values, double expected) {
  for (const Measured& m : values) {
    CAPTURE(m.lx);
    CAPTURE(m.error);
    CAPTURE(expected);
    CHECK(std::abs(m.lx - expected) < 1e-3 * expected + 5 * m.error);
    CHECK(m.error < 0.01 * expected);
  }
}

template <class T>
void append(std::string& bytes, std::initializer_list<T> values) {
  for (const T v : values) bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
}

}  // namespace

TEST_CASE("thin boxes of solid glass are panes; double glazing is two panes") {
  const char* const points = "x,y,z,nx,ny,nz\n.3,.1,0,0,0,1\n1.7,0,0,0,0,1\n";
  for (const int panes : {1, 2}) {
    const Folder folder;
    const std::string scene =
        folder.write("s.pbrt", std::string("WorldBegin\n") + black_floor + glass_box(1, 1.004) +
                                   (panes == 2 ? glass_box(1.016, 1.02) : ""));
    CAPTURE(panes);
    for (const char* method : {"certified", "fixed"})
      check(measure(
                folder, scene, points,
                {"--sky", "even,10000", "--up", "0,0,1", "--method", method, "--indirect", "none"}),
            under_sky(panes));
  }
}

TEST_CASE("a thick body of glass stays a solid body") {
  const Folder folder;
  const std::string scene =
      folder.write("s.pbrt", std::string("WorldBegin\n") + black_floor + glass_box(1, 100));
  const auto values = measure(folder, scene, "x,y,z,nx,ny,nz\n.3,.1,0,0,0,1\n",
                              {"--sky", "even,10000", "--up", "0,0,1", "--indirect", "none"});
  CHECK(values[0].lx < 1);  // refracted light is a caustic
}

TEST_CASE("glTF: transmission without volume is a pane, tinted by the base colour") {
  const Folder folder;
  std::string bytes;
  append<float>(bytes, {-500, 0, -500, -500, 0, 500, 500, 0, 500, 500, 0, -500});
  append<uint32_t>(bytes, {0, 1, 2, 0, 2, 3});
  folder.write("s.bin", bytes);
  const std::string scene = folder.write("s.gltf", R"({"asset":{"version":"2.0"},"scene":0,
"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0},{"mesh":1,"translation":[0,1,0]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0}]},
{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":1}]}],
"materials":[{"pbrMetallicRoughness":{"baseColorFactor":[0,0,0,1],"metallicFactor":0}},
{"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,1,1],"metallicFactor":0,"roughnessFactor":0},
"extensions":{"KHR_materials_transmission":{"transmissionFactor":1}}}],
"extensionsUsed":["KHR_materials_transmission"],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[-500,0,-500],
"max":[500,0,500]},{"bufferView":1,"componentType":5125,"count":6,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},
{"buffer":0,"byteOffset":48,"byteLength":24}],"buffers":[{"uri":"s.bin","byteLength":72}]})");
  const double tint = 0.2126 * 0.5 + 0.7152 * 0.25 + 0.0722 * 1;
  check(measure(folder, scene, "x,y,z,nx,ny,nz\n.3,0,.1,0,1,0\n1.7,0,0,0,1,0\n",
                {"--sky", "even,10000", "--indirect", "none"}),
        tint * under_sky(1));
}

TEST_CASE("OBJ: materials with d below 1 let light straight through") {
  const Folder folder;
  folder.write("s.mtl", "newmtl floor\nKd 0 0 0\nnewmtl glass\nKd 1 1 1\nd 0\n");
  const std::string scene =
      folder.write("s.obj",
                   "mtllib s.mtl\nv -500 0 -500\nv -500 0 500\nv 500 0 500\nv 500 0 -500\n"
                   "v -500 1 -500\nv -500 1 500\nv 500 1 500\nv 500 1 -500\n"
                   "usemtl floor\nf 1 2 3 4\nusemtl glass\nf 5 6 7 8\n");
  check(measure(folder, scene, "x,y,z,nx,ny,nz\n.3,0,.1,0,1,0\n1.7,0,0,0,1,0\n",
                {"--sky", "even,10000", "--indirect", "none"}),
        under_sky(1));
}

TEST_CASE("a pane reflects the room in front of it without noise at 4 viewing rays") {
  const Folder folder;
  const std::string scene = folder.write(
      "s.pbrt", std::string("LookAt 0 0 3  2 0 1  0 0 1\nCamera \"perspective\" \"float fov\" [2]\n"
                            "WorldBegin\nLightSource \"infinite\" \"rgb L\" [2 2 2]\n") +
                    black_floor + pbrt_glass({{{-500, -500, 1}, {1000, 0, 0}, {0, 1000, 0}}}));
  for (const char* method : {"certified", "fixed"}) {
    const std::string out = folder.path("o.pfm");
    const Finished f =
        run_program(folder, {"render", scene, "-o", out, "--size", "8x6", "--spp", "4", "--method",
                             method, "--indirect", "none", "--quiet"});
    CAPTURE(f.err);
    REQUIRE(f.status == 0);
    const double expected = 2 * (1 - pane_transmittance(std::sqrt(0.5)));
    for (const Rgb& p : read_image(out).pixels)
      CHECK(double(p.g) == doctest::Approx(expected).epsilon(0.06));
  }
}

}  // namespace test_thin_glass
