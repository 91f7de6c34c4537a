// The four commands: what they print and write, and what they guarantee.
#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "image/read_image.h"
#include "program.h"

using namespace troffer;
using namespace troffer::test;

namespace test_commands {
using Json = nlohmann::json;

namespace {

double mean(const Image& image) {
  double sum = 0;
  for (const Rgb& p : image.pixels) sum += double(p.r) + double(p.g) + double(p.b);
  return sum / double(3 * image.pixels.size());
}

// Runs the program and expects success without remarks.
Finished run_well(const Folder& folder, const std::vector<std::string>& arguments) {
  Finished f = run_program(folder, arguments);
  CAPTURE(f.err);
  CHECK(f.status == 0);
  CHECK(f.remarks().empty());
  return f;
}

// Returns the irradiance under the middle of lit_floor_pbrt's source, times π / L: four form
// factors of a rectangle a × a over its corner at height h (parallel planes).
double floor_irradiance() {
  const double a = 0.25, r = std::sqrt(1 + a * a);
  return 4 * 5 * (a / r * std::atan(a / r));
}

}  // namespace

TEST_CASE("all four formats in one run hold the same picture") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  const Finished f = run_well(
      folder, {"render", scene, "--spp", "8", "-o", folder.path("a.exr"), "-o",
               folder.path("a.hdr"), "-o", folder.path("a.pfm"), "-o", folder.path("a.png")});
  CHECK(f.out.empty());
  CHECK(folder.names() ==
        std::vector<std::string>{"a.exr", "a.hdr", "a.pfm", "a.png", "room.pbrt"});
  const Image exr = read_image(folder.path("a.exr")), pfm = read_image(folder.path("a.pfm")),
              hdr = read_image(folder.path("a.hdr")), png = read_image(folder.path("a.png"));
  REQUIRE(exr.width == 40);
  REQUIRE(exr.height == 30);
  CHECK(exr.pixels == pfm.pixels);
  CHECK(mean(exr) > 0.1);
  CHECK(mean(hdr) == doctest::Approx(mean(exr)).epsilon(0.01));
  CHECK(png.width == 40);
  CHECK(mean(png) > 0.01);
}

TEST_CASE("output is byte-identical for any number of threads and in repeated runs") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  for (const std::vector<std::string>& method : std::vector<std::vector<std::string>>{
           {}, {"--method", "path"}, {"--method", "fixed", "--shadow-rays", "3"}}) {
    const auto render = [&](const std::string& name, const std::string& threads) {
      std::vector<std::string> arguments{"render",    scene,
                                         "--spp",     "20",
                                         "--threads", threads,
                                         "--aov",     "albedo,normal,depth,direct,error",
                                         "-o",        folder.path(name)};
      arguments.insert(arguments.end(), method.begin(), method.end());
      run_well(folder, arguments);
      return read_file(folder.path(name));
    };
    const std::string one = render("1.exr", "1");
    CHECK(one.size() > 1000);
    CHECK(one == render("3.exr", "3"));
    CHECK(one == render("again.exr", "1"));
  }
}

TEST_CASE("layers are in the EXR") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt), out = folder.path("o.exr");
  run_well(folder, {"render", scene, "-o", out, "--aov",
                    "albedo,normal,depth,position,direct,indirect,shadow_rays,error"});
  const std::string bytes = read_file(out);
  for (const char* channel : {"albedo.R", "normal.X", "depth.Z", "position.Y", "direct.G",
                              "indirect.B", "shadow_rays.V", "error.V"}) {
    CAPTURE(channel);
    CHECK(bytes.find(channel) != bytes.npos);
  }
}

TEST_CASE("--stats holds every key") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  run_well(folder, {"render", scene, "-o", folder.path("o.exr"), "--method", "fixed", "--spp", "3",
                    "--shadow-rays", "5", "--threads", "2", "--stats", folder.path("s.json")});
  const Json s = Json::parse(read_file(folder.path("s.json")));
  for (const char* key :
       {"version", "method", "width", "height", "threads", "viewing_rays", "shadow_rays",
        "shadow_rays_per_viewing_ray", "lit_certified", "dark_certified", "masked", "mixed",
        "nan_samples", "seconds", "peak_memory_mb"}) {
    CAPTURE(key);
    CHECK(s.contains(key));
  }
  for (const char* key : {"import", "build", "preprocess", "render", "write", "total"}) {
    CAPTURE(key);
    CHECK(s["seconds"].contains(key));
    CHECK(s["seconds"][key].get<double>() >= 0);
  }
  CHECK(s["method"] == "fixed");
  CHECK(s["width"] == 40);
  CHECK(s["height"] == 30);
  CHECK(s["threads"] == 2);
  CHECK(s["viewing_rays"] == 40 * 30 * 3);
  CHECK(s["shadow_rays_per_viewing_ray"].get<double>() ==
        doctest::Approx(s["shadow_rays"].get<double>() / 3600));
  CHECK(s["shadow_rays"].get<int>() <= 3600 * 5);
  CHECK(s["shadow_rays"].get<int>() > 3600);
  CHECK(s["nan_samples"] == 0);
  CHECK(s["peak_memory_mb"].get<double>() > 1);
}

TEST_CASE("--stats counts exactly the viewing rays of the picture") {
  const Folder folder;
  // The picture shows a single radiance, so no pixel is refined.
  const std::string scene = folder.write("lamp.pbrt", R"(LookAt 0 0 0  0 0 1  0 1 0
Camera "perspective" "float fov" [40]
WorldBegin
AreaLightSource "diffuse" "rgb L" [5 5 5]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3]
  "point3 P" [-9 -9 2  -9 9 2  9 9 2  9 -9 2]
)");
  run_well(folder, {"render", scene, "-o", folder.path("o.exr"), "--size", "40x30", "--spp", "4",
                    "--max-spp", "16", "--stats", folder.path("s.json")});
  const Json s = Json::parse(read_file(folder.path("s.json")));
  CHECK(s["max_spp"] == 16);
  CHECK(s["viewing_rays"] == 40 * 30 * 4);
  CHECK(mean(read_image(folder.path("o.exr"))) == doctest::Approx(5));
}

TEST_CASE("info lists what the scene holds") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  const Json j = Json::parse(run_well(folder, {"info", scene, "--json"}).out);
  for (const char* key : {"triangles", "meshes", "materials", "textures", "emitters",
                          "emitter_triangles", "lights", "cameras", "bounds", "warnings"}) {
    CAPTURE(key);
    CHECK(j.contains(key));
  }
  CHECK(j["triangles"] == 4);
  CHECK(j["emitters"] == 1);
  CHECK(j["emitter_triangles"] == 2);
  CHECK(j["lights"] == Json{"emitter0"});
  CHECK(j["cameras"].size() == 1);
  CHECK(j["bounds"] == Json::parse("[[-2,-2,0],[2,2,2]]"));
  CHECK(j["memory_mb"]["geometry"] > 0);
  CHECK(j["memory_mb"]["geometry"] < 0.001);
  CHECK(j["memory_mb"]["textures"] == 0);
  CHECK(j["memory_mb"]["peak"] > 1);
  CHECK(run_well(folder, {"info", scene}).out.find("emitter0") != std::string::npos);
}

TEST_CASE("compare prints its numbers as text and as JSON") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  const std::string a = folder.path("a.exr"), b = folder.path("b.exr"), c = folder.path("c.exr");
  run_well(folder, {"render", scene, "-o", a, "--method", "path"});
  run_well(folder, {"render", scene, "-o", b, "--method", "path", "--seed", "7"});
  run_well(folder, {"render", scene, "-o", c, "--size", "41x30"});
  const char* const keys[] = {"mean_image", "mean_reference", "average_difference",
                              "rmse",       "relative_rmse",  "flip"};
  const Json different = Json::parse(run_well(folder, {"compare", a, b, "--json"}).out);
  const Json same = Json::parse(run_well(folder, {"compare", a, a, "--json"}).out);
  const std::string text = run_well(folder, {"compare", a, b}).out;
  for (const char* key : keys) {
    CAPTURE(key);
    REQUIRE(different.contains(key));
    CHECK(different[key].get<double>() > 0);
    const auto at = ("\n" + text).find("\n" + std::string(key));
    REQUIRE(at != std::string::npos);
    std::istringstream words(text.substr(at));
    std::string name;
    double value = 0;
    words >> name >> value;
    CHECK(name == key);
    CHECK(value == doctest::Approx(different[key].get<double>()).epsilon(1e-4));
  }
  CHECK(same["rmse"] == 0);
  CHECK(same["flip"] == 0);
  CHECK(same["mean_image"] == same["mean_reference"]);
  const Finished mismatch = run_program(folder, {"compare", a, c});
  CHECK(mismatch.status == 1);
  CHECK(mismatch.out.empty());
  CHECK(mismatch.error_lines().size() == 1);
}

TEST_CASE("a crop shows a part of the picture") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  for (const std::string method : {"certified", "path"}) {
    run_well(folder, {"render", scene, "-o", folder.path("whole.pfm"), "--method", method});
    run_well(folder, {"render", scene, "-o", folder.path("part.pfm"), "--crop", "7,3,20,21",
                      "--method", method});
    const Image whole = read_image(folder.path("whole.pfm")),
                part = read_image(folder.path("part.pfm"));
    REQUIRE(part.width == 13);
    REQUIRE(part.height == 18);
    for (int y = 0; y < 18; ++y)
      for (int x = 0; x < 13; ++x) REQUIRE(part.at(x, y) == whole.at(x + 7, y + 3));
  }
}

TEST_CASE("--light keeps only the sources it names") {
  const Folder folder;
  const std::string scene = folder.write("two.pbrt", std::string(lit_floor_pbrt) + R"(
AreaLightSource "diffuse" "rgb L" [100 0 0]
Shape "sphere" "float radius" [0.1]
)");
  const auto render = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render", scene, "-o", folder.path("o.pfm"), "--spp", "64"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    run_well(folder, arguments);
    return read_image(folder.path("o.pfm"));
  };
  const Image all = render({}), first = render({"--light", "emitter0"}),
              second = render({"--light", "emitter1"}),
              both = render({"--light", "emitter1,emitter0"});
  CHECK(all.pixels == both.pixels);
  CHECK(mean(first) > 0);
  CHECK(mean(second) > 0);
  CHECK(mean(first) + mean(second) == doctest::Approx(mean(all)).epsilon(0.03));
  double green = 0;
  for (const Rgb& p : second.pixels) green += double(p.g);
  CHECK(green == 0);
}

TEST_CASE("measure: the header, the values, the errors") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  const std::string points =
      folder.write("p.csv", "nx,ny,nz,x,y,z\r\n0,0,2,0,0,0\r\n\r\n0,0,-1,0,0,0\r\n");
  for (const std::string method : {"certified", "path", "fixed"}) {
    const Finished f = run_well(
        folder, {"measure", scene, "--points", points, "--method", method, "--indirect", "none"});
    std::istringstream in(f.out);
    std::string line;
    std::getline(in, line);
    CHECK(line ==
          "x,y,z,nx,ny,nz,irradiance_r,irradiance_g,irradiance_b,illuminance_lx,standard_error");
    std::vector<std::vector<double>> rows;
    while (std::getline(in, line)) {
      std::istringstream fields(line);
      rows.emplace_back();
      for (std::string field; std::getline(fields, field, ',');)
        rows.back().push_back(std::stod(field));
      CHECK(rows.back().size() == 11);
    }
    REQUIRE(rows.size() == 2);
    const double e = floor_irradiance();
    CHECK(rows[0][6] == doctest::Approx(e).epsilon(0.01));
    CHECK(rows[0][9] == doctest::Approx(179 * e).epsilon(0.01));
    // The output has seven digits; certified has no noise without occluders.
    CHECK(std::abs(rows[0][9] - 179 * e) < 5 * rows[0][10] + 1e-6 * rows[0][9]);
    CHECK(rows[1][9] == 0);
    run_well(folder, {"measure", scene, "--points", points, "--method", method, "--indirect",
                      "none", "-o", folder.path("o.csv"), "--threads", "1"});
    CHECK(read_file(folder.path("o.csv")) == f.out);
  }
}

TEST_CASE("scenes without surfaces and lights are refused; info lists what they hold") {
  const struct {
    const char *name, *text;
  } empty[] = {
      {"nothing.pbrt", "WorldBegin\n"},
      {"nothing.obj", "# nothing\n"},
      {"nothing.gltf", "{\"asset\": {\"version\": \"2.0\"}}"},
  };
  for (const auto& e : empty) {
    const Folder folder;
    const std::string scene = folder.write(e.name, e.text), out = folder.path("o.pfm");
    const Finished f = run_program(folder, {"render", scene, "-o", out, "--size", "16x12"});
    CHECK(f.status == 1);
    CHECK(f.err == "error: " + scene + ":1:1: is empty: it has neither surfaces nor lights\n");
    CHECK(folder.names() == std::vector<std::string>{e.name});
    CHECK(run_program(folder, {"info", scene, "--json"}).status == 0);
  }
}

TEST_CASE("scenes without light or camera: a warning, and no sky unless requested") {
  const struct {
    const char *name, *text;
  } odd[] = {
      {"dark.pbrt", "WorldBegin\nShape \"sphere\"\n"},
      {"dark.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
  };
  for (const auto& o : odd) {
    const Folder folder;
    CAPTURE(o.name);
    const std::string scene = folder.write(o.name, o.text), out = folder.path("o.pfm");
    const std::vector<std::string> arguments{"render", scene,   "-o",    out,
                                             "--size", "16x12", "--sky", "none"};
    const Finished f = run_program(folder, arguments);
    CHECK(f.status == 0);
    REQUIRE(!f.error_lines().empty());
    for (const std::string& line : f.error_lines()) CHECK(line.rfind("warning: ", 0) == 0);
    const Image image = read_image(out);
    CHECK(image.width == 16);
    CHECK(mean(image) == 0);
    auto quiet = arguments;
    quiet.push_back("--quiet");
    run_well(folder, quiet);
    CHECK(run_program(folder, {"info", scene, "--json"}).status == 0);
  }
}

TEST_CASE("render and measure take certified visibility by default") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  const std::string points = folder.write("p.csv", "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n1,0,0,0,0,1\n");
  const auto render = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{
        "render", scene, "-o", folder.path("o.pfm"), "--stats", folder.path("s.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    run_well(folder, arguments);
    return read_file(folder.path("o.pfm"));
  };
  const auto stats = [&] { return Json::parse(read_file(folder.path("s.json"))); };
  // In so small a picture of a single plate plain paths would cost less than cells.
  const std::string plain = render({"--indirect", "cells"});
  const Json of_plain = stats();
  CHECK(of_plain["method"] == "certified");
  CHECK(of_plain["spp"] == 4);
  CHECK(of_plain["max_spp"] == 2048);
  CHECK(of_plain["lit_certified"].get<int>() > 40 * 30);
  // Samples concentrate on the edges of floor and lamp.
  CHECK(of_plain["viewing_rays"].get<int>() > 40 * 30 * 4);
  CHECK(of_plain["viewing_rays"].get<int>() < 40 * 30 * 32);
  CHECK(plain == render({"--indirect", "cells", "--method", "certified", "--spp", "4"}));
  CHECK(plain != render({"--indirect", "cells", "--max-spp", "4"}));
  CHECK(stats()["viewing_rays"] == 40 * 30 * 4);
  // Nearly all visibility of first viewing rays is proved. Further ones may sample lights.
  CHECK(stats()["shadow_rays"].get<int>() < 40 * 30 * 4 / 20);
  CHECK(render({}) == render({"--method", "certified"}));
  CHECK(plain != render({"--method", "path"}));
  CHECK(stats()["viewing_rays"] == 40 * 30 * 4);

  const auto measured = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"measure", scene, "--points", points};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_well(folder, arguments).out;
  };
  CHECK(measured({}) == measured({"--method", "certified"}));
  CHECK(measured({}) != measured({"--method", "path"}));
  CHECK(measured({"--method", "cached-path"}).find("illuminance_lx") != std::string::npos);
}

TEST_CASE("options that the method does not use are named in a warning") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  const std::string points = folder.write("p.csv", "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n");
  const struct {
    std::string method, option, value;
    bool is_used;
  } cases[] = {
      {"certified", "--depth", "3", false},      {"path", "--depth", "3", true},
      {"certified", "--error", "0.1", true},     {"path", "--error", "0.1", false},
      {"certified", "--max-spp", "8", true},     {"path", "--max-spp", "8", true},
      {"kj92", "--max-spp", "8", true},          {"fixed", "--max-spp", "8", true},
      {"fixed", "--shadow-rays", "2", true},     {"certified", "--shadow-rays", "2", false},
      {"kj92", "--variance", "0.5", true},       {"certified", "--variance", "0.5", false},
      {"certified", "--coherence", "on", false}, {"path", "--select", "emitter0", false},
  };
  for (const auto& c : cases) {
    CAPTURE(c.method);
    CAPTURE(c.option);
    std::vector<std::string> arguments{"render",   scene,    "-o",     folder.path("o.pfm"),
                                       "--size",   "16x12",  "--spp",  "1",
                                       "--method", c.method, c.option, c.value};
    const Finished f = run_program(folder, arguments);
    CHECK(f.status == 0);
    CHECK(f.error_lines().size() == (c.is_used ? 0 : 1));
    if (!c.is_used) CHECK(f.err.rfind("warning: " + c.option + " belongs to --method ", 0) == 0);
    arguments.push_back("--quiet");
    run_well(folder, arguments);
  }
  const Finished f = run_program(
      folder, {"measure", scene, "--points", points, "--depth", "2", "-o", folder.path("o.csv")});
  CHECK(f.status == 0);
  CHECK(f.remarks() == "warning: --depth belongs to --method path; certified does not use it\n");
}

}  // namespace test_commands
