// Files of `troffer convert` and `bake` give the same light as their inputs. Expected values: a
// sheet of alpha a transmits the share 1 - a (glTF 2.0 §3.9.4, pbrt-v4 file format "alpha", Mitsuba
// 3 "mask"). Other files are compared with what they were made from.
#include <doctest/doctest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <map>
#include <random>

#include "image/read_image.h"
#include "program.h"

using namespace troffer;
using namespace troffer::test;

namespace test_convert_command {

namespace {

const std::vector<std::string> targets{"out.gltf", "out.glb", "out.pbrt"};

std::string sample(const std::string& name) {
  return std::string(TROFFER_SOURCE_DIR "/tests/app/convert/") + name;
}

std::string converted(const Folder& folder, const std::string& scene, const std::string& target) {
  const Finished f = run_program(folder, {"convert", scene, folder.path(target), "--quiet"});
  CAPTURE(f.err);
  REQUIRE(f.status == 0);
  return folder.path(target);
}

std::string baked(const Folder& folder, const std::string& scene) {
  const Finished f = run_program(folder, {"bake", scene, "-o", folder.path("baked.gltf"), "--spp",
                                          "4", "--resolution", "32", "--quiet"});
  CAPTURE(f.err);
  REQUIRE(f.status == 0);
  return folder.path("baked.gltf");
}

std::vector<double> lux(const Folder& folder, const std::string& scene, const std::string& points,
                        const std::vector<std::string>& options = {"--indirect", "none"}) {
  std::vector<std::string> words{"measure", scene, "--points", points, "--quiet"};
  words.insert(words.end(), options.begin(), options.end());
  const Finished f = run_program(folder, words);
  CAPTURE(f.err);
  REQUIRE(f.status == 0);
  std::vector<double> out;
  for (const Measured& m : measured(f)) out.push_back(m.lx);
  return out;
}

void check_near(const std::vector<double>& is, const std::vector<double>& wanted, double most) {
  REQUIRE(is.size() == wanted.size());
  for (size_t i = 0; i < is.size(); ++i)
    CHECK(std::abs(is[i] - wanted[i]) <= most * std::abs(wanted[i]) + 1e-6);
}

// A grey TGA, with row 0 at the top.
std::string tga(int width, int height, const std::vector<uint8_t>& texels) {
  std::string out(18, '\0');
  out[2] = 3;
  out[12] = char(width);
  out[14] = char(height);
  out[16] = 8;
  out[17] = 32;
  return out + std::string(texels.begin(), texels.end());
}

const std::string below = "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n";

// A lamp of 1 × 1 m, 2 m above the point, and a sheet between them. before: directives before its
// shape; parameters: of the shape.
std::string sheet_pbrt(const std::string& before, const std::string& parameters) {
  return "WorldBegin\nAttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n"
         "Shape \"trianglemesh\" \"point3 P\" [-.5 -.5 2 -.5 .5 2 .5 .5 2 .5 -.5 2] \"integer "
         "indices\" [0 1 2 0 2 3]\nAttributeEnd\n" +
         before +
         "Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5]\nShape \"trianglemesh\" \"point3 P\" "
         "[-2 -2 1 2 -2 1 2 2 1 -2 2 1] \"integer indices\" [0 1 2 0 2 3] \"point2 uv\" [0 0 1 0 1 "
         "1 0 1] " +
         parameters + "\n";
}

const std::string sheet_obj =
    "mtllib s.mtl\nv -.5 -.5 2\nv -.5 .5 2\nv .5 .5 2\nv .5 -.5 2\nv -2 -2 1\nv 2 -2 1\nv 2 2 1\n"
    "v -2 2 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl lamp\nf 1 2 3 4\nusemtl sheet\n"
    "f 5/1 6/2 7/3 8/4\n";

std::string sheet_xml(const std::string& opacity) {
  return "<scene version=\"3.0.0\"><shape type=\"rectangle\"><transform name=\"to_world\"><scale "
         "value=\".5\"/><rotate x=\"1\" angle=\"180\"/><translate z=\"2\"/></transform><emitter "
         "type=\"area\"><rgb name=\"radiance\" value=\"1\"/></emitter></shape><shape "
         "type=\"rectangle\"><transform name=\"to_world\"><scale value=\"2\"/><translate "
         "z=\"1\"/></transform><bsdf type=\"mask\">" +
         opacity + "<bsdf type=\"diffuse\"/></bsdf></shape></scene>";
}

}  // namespace

TEST_CASE(
    "partial alpha of glTF, factors, images and masks, survives in every format and in bake") {
  const Folder folder;
  const std::string points = folder.write("p.csv", read_file(sample("alpha.csv")));
  const std::map<std::string, double> wanted{
      {"blend03.gltf", 700}, {"blend07.gltf", 300}, {"mask-texture.gltf", 1000}};
  for (const auto& [name, lx] : wanted) {
    CAPTURE(name);
    for (const std::string& target : targets) {
      CAPTURE(target);
      check_near(lux(folder, converted(folder, sample(name), target), points), {lx}, 0.01);
    }
    check_near(lux(folder, baked(folder, sample(name)), points), {lx}, 0.01);
  }
}

TEST_CASE("opacity of pbrt, OBJ and Mitsuba survives in every format") {
  const Folder folder;
  const std::string points = folder.write("p.csv", below);
  folder.write("a.tga", tga(2, 2, {51, 51, 51, 51}));  // alpha .2
  folder.write("s.mtl",
               "newmtl lamp\nKd 0 0 0\nKe 1 1 1\nnewmtl sheet\nKd .5 .5 .5\nmap_d a.tga\n");
  const std::string texture =
      "Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"a.tga\" \"string encoding\" "
      "\"linear\"\n";
  const double open =
      lux(folder, folder.write("open.pbrt", sheet_pbrt("", "\"float alpha\" 0")), points)[0];
  struct Case {
    std::string file;
    double passes;
  };
  const std::vector<Case> cases{
      {folder.write("a.pbrt", sheet_pbrt("", "\"float alpha\" .3")), 0.7},
      {folder.write("b.pbrt", sheet_pbrt(texture, "\"texture alpha\" \"a\"")), 0.8},
      {folder.write("c.obj", sheet_obj), 0.8},
      {folder.write("d.xml", sheet_xml("<float name=\"opacity\" value=\".6\"/>")), 0.4}};
  for (const Case& c : cases) {
    CAPTURE(c.file);
    const double before = lux(folder, c.file, points)[0];
    CHECK(before == doctest::Approx(open * c.passes).epsilon(0.02));
    for (const std::string& target : targets) {
      CAPTURE(target);
      const double after = lux(
          folder, converted(folder, c.file, target),
          target == "out.pbrt" ? points : folder.write("y.csv", "x,y,z,nx,ny,nz\n0,0,0,0,1,0\n"),
          {"--indirect", "none", "--up", "0,1,0"})[0];
      CHECK(after == doctest::Approx(before).epsilon(0.02));
    }
  }
}

TEST_CASE("colours of vertices keep their brightness") {
  const Folder folder;
  const std::string points = folder.write("p.csv", read_file(sample("colours.csv")));
  const std::vector<double> wanted{216.1, 260.1};
  const std::vector<std::string> options{"--method", "path", "--spp", "4096"};
  for (const std::string& target : targets) {
    CAPTURE(target);
    check_near(lux(folder, converted(folder, sample("colours.gltf"), target), points, options),
               wanted, 0.02);
  }
  check_near(lux(folder, baked(folder, sample("colours.gltf")), points, options), wanted, 0.02);
}

TEST_CASE("emission images keep their placement in pbrt") {
  const Folder folder;
  const std::string points = folder.write("p.csv", read_file(sample("screen.csv")));
  check_near(lux(folder, converted(folder, sample("screen.gltf"), "out.pbrt"), points),
             {359.8, 315.2, 442.1}, 0.01);
  for (const std::string& target : targets) {
    CAPTURE(target);
    check_near(lux(folder, converted(folder, sample("turned.gltf"), target), points),
               lux(folder, sample("turned.gltf"), points), 0.01);
  }
}

TEST_CASE("normal maps keep their tilt in pbrt") {
  const Folder folder;
  const std::map<std::string, std::array<float, 4>> wanted{
      {"x-tilt-top.gltf", {0.578f, 0.578f, 0.475f, 0.475f}},
      {"y-tilt-left.gltf", {0.578f, 0.475f, 0.578f, 0.475f}}};
  for (const auto& [name, values] : wanted) {
    for (const std::string& target : targets) {
      CAPTURE(name);
      CAPTURE(target);
      const Finished f =
          run_program(folder, {"render", converted(folder, sample(name), target), "--size", "16x16",
                               "--indirect", "none", "-o", folder.path("o.pfm"), "--quiet"});
      REQUIRE(f.status == 0);
      const Image picture = read_image(folder.path("o.pfm"));
      const float unit = target == "out.pbrt" ? 179.0f : 1.0f;
      size_t i = 0;
      for (const auto& [x, y] : {std::pair{3, 3}, {12, 3}, {3, 12}, {12, 12}})
        CHECK(picture.at(x, y).g * unit == doctest::Approx(double(values[i++])).epsilon(0.01));
    }
  }
}

TEST_CASE("scenes with z up are upright in glTF") {
  const Folder folder;
  // A floor of 10 × 10 m under an overcast sky of 10 000 lx.
  const std::string scene = folder.write(
      "f.rad",
      "void plastic g 0 0 5 .5 .5 .5 0 0\ng polygon f 0 0 12 -5 -5 0 5 -5 0 5 5 0 -5 5 0\n");
  const std::vector<std::string> options{"--indirect", "none", "--sky", "overcast,10000"};
  check_near(lux(folder, scene, folder.write("z.csv", "x,y,z,nx,ny,nz\n1,2,.1,0,0,1\n"), options),
             {10000}, 0.01);
  const std::string points = folder.write("y.csv", "x,y,z,nx,ny,nz\n1,.1,-2,0,1,0\n");
  for (const std::string target : {"out.gltf", "out.glb"})
    check_near(lux(folder, converted(folder, scene, target), points, options), {10000}, 0.01);
  const std::string lit = folder.write("room.pbrt", lit_floor_pbrt);
  const Finished f = run_program(folder, {"convert", scene, folder.path("out.gltf")});
  CHECK(f.err.find("(x, y, z) becomes (x, z, -y)") != std::string::npos);
}

TEST_CASE("a convert that fails or is killed leaves the old file with its old data") {
  const Folder folder;
  const auto scene = [&](double radiance) {
    std::string text = lit_floor_pbrt;
    for (int i = 0; i < 40; ++i)
      text +=
          "Translate 0 0 -" + std::to_string(radiance) + "\nShape \"sphere\" \"float radius\" .1\n";
    return folder.write("in.pbrt", text);
  };
  const auto files = [&] {
    std::map<std::string, std::string> out{{"out.gltf", read_file(folder.path("out.gltf"))}};
    for (const auto& e : std::filesystem::directory_iterator(folder.path("out_files")))
      out[e.path().filename().string()] = read_file(e.path().string());
    return out;
  };
  converted(folder, scene(1), "out.gltf");
  const auto before = files();
  REQUIRE(before.size() == 2);
  const std::string other = scene(2);
  // The limit is too small for the text; some data files may fit.
  Running limited(folder, {"convert", other, folder.path("out.gltf"), "--quiet"}, [] {
    const rlimit most{4096, 4096};
    setrlimit(RLIMIT_FSIZE, &most);
  });
  CHECK(limited.wait().status == 1);
  CHECK(files() == before);
  const Finished whole = run_program(folder, {"convert", other, folder.path("whole.gltf")});
  std::mt19937 random(1);
  for (int i = 0; i < 20; ++i) {
    Running program(folder, {"convert", other, folder.path("out.gltf"), "--quiet"});
    program.let_work(whole.processor_seconds * double(random()) / 4294967296.0);
    program.send(SIGKILL);
    if (program.wait().status == 0) {
      converted(folder, scene(1), "out.gltf");
      scene(2);
      continue;
    }
    // The old file keeps all of its old data; new data files are not referenced.
    const auto now = files();
    if (now.at("out.gltf") == before.at("out.gltf"))
      for (const auto& [name, bytes] : before) CHECK(now.at(name) == bytes);
  }
}

}  // namespace test_convert_command
