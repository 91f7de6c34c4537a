// The up direction: decided, reported, and chosen by --up, in every command that loads a scene.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "program.h"

using namespace troffer::test;

namespace test_up_option {

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// A closed box from 0,0,0 with faces outward.
std::string box_obj(const std::string& x, const std::string& y, const std::string& z) {
  std::string text;
  for (const char* a : {"0", x.c_str()})
    for (const char* b : {"0", y.c_str()})
      for (const char* c : {"0", z.c_str()})
        text += std::string("v ") + a + " " + b + " " + c + "\n";
  return text + "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n";
}

// A corridor of 10 × 3 × 2 m with y up; its lamp faces down.
const char* const corridor_obj =
    "mtllib c.mtl\n"
    "v 0 0 2\nv 10 0 2\nv 10 0 0\nv 0 0 0\nv 0 3 0\nv 10 3 0\nv 10 3 2\nv 0 3 2\n"
    "v 4 2.99 0.7\nv 6 2.99 0.7\nv 6 2.99 1.3\nv 4 2.99 1.3\n"
    "usemtl w\nf 1 2 3 4\nf 5 6 7 8\nf 4 3 6 5\nf 2 1 8 7\nf 1 4 5 8\nf 3 2 7 6\n"
    "usemtl l\nf 9 10 11 12\n";
const char* const corridor_mtl = "newmtl w\nKd .5 .5 .5\nnewmtl l\nKd 0 0 0\nKe 20 20 20\n";

const char* const no_evidence =
    "warning: nothing in the file says which way is up: y is taken, as in most OBJ files (--up z "
    "if it stands on z)";

}  // namespace

// An unobstructed horizontal plane has the sky's own illuminance: 10 000 lx.
TEST_CASE("a roof under a sky of 10 000 lx has 10 000 lx, or a warning names --up") {
  const Folder folder;
  const std::string corridor = folder.write("corridor.obj", box_obj("10", "3", "2")),
                    tower = folder.write("tower.obj", box_obj("20", "20", "60"));
  const std::string on_corridor = folder.write("c.csv", "x,y,z,nx,ny,nz\n5,3.01,1,0,1,0\n"),
                    on_tower = folder.write("t.csv", "x,y,z,nx,ny,nz\n10,10,60.01,0,0,1\n");
  const auto run = [&](const std::string& scene, const std::string& points,
                       const std::vector<std::string>& more) {
    std::vector<std::string> words{"measure",        scene,        "--points", points, "--sky",
                                   "overcast,10000", "--indirect", "none"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(folder, words);
  };
  const Finished guessed = run(corridor, on_corridor, {});
  CHECK(measured(guessed)[0].lx == doctest::Approx(10000).epsilon(0.002));
  CHECK(guessed.error_lines() == std::vector<std::string>{no_evidence});
  CHECK(run(tower, on_tower, {}).error_lines() == std::vector<std::string>{no_evidence});
  for (const char* up : {"z", "+z", "0,0,1", "0,0,2.5"}) {
    const Finished asked = run(tower, on_tower, {"--up", up});
    CHECK(measured(asked)[0].lx == doctest::Approx(10000).epsilon(0.002));
    CHECK(asked.remarks() == "");
  }
  CHECK(run(tower, on_tower, {"--quiet"}).err == "");
}

TEST_CASE("a corridor's floor is assessed, not its wall") {
  const Folder folder;
  folder.write("c.mtl", corridor_mtl);
  const std::string scene = folder.write("c.obj", corridor_obj), out = folder.path("r");
  const Finished f = run_program(folder, {"report", scene, "-o", out, "--pictures", "off", "--spp",
                                          "16", "--cylindrical", "off"});
  REQUIRE(f.status == 0);
  CHECK(
      contains(f.err, "note: y is up, by a lamp that faces down (--up chooses another direction)"));
  const auto j = nlohmann::json::parse(read_file(out + "/report.json"));
  CHECK(j["info"]["settings"]["Upward direction"] == "y, by a lamp that faces down");
  CHECK(j["surfaces"][0]["area_m2"].get<double>() == doctest::Approx(20));
}

TEST_CASE("info shows the chosen up direction and any doubt; --up settles both") {
  const Folder folder;
  const std::string scene = folder.write("tower.obj", box_obj("20", "20", "60"));
  const Finished text = run_program(folder, {"info", scene});
  CHECK(contains(text.out, "up         y, as in most OBJ files\n"));
  CHECK(contains(text.out, "nothing in the file says which way is up"));
  const auto json = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"info", scene, "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return nlohmann::json::parse(run_program(folder, words).out)["up"];
  };
  CHECK(json({})["direction"] == std::vector<double>{0, 1, 0});
  CHECK(contains(json({})["doubt"], "--up z if it stands on z"));
  CHECK(json({"--up", "-z"})["direction"] == std::vector<double>{0, 0, -1});
  CHECK(json({"--up", "-z"})["reason"] == "by --up");
  CHECK(json({"--up", "-z"})["doubt"] == "");
}

TEST_CASE(
    "statistics state the up direction; measuring points does not depend on it and prints no "
    "note") {
  const Folder folder;
  folder.write("c.mtl", corridor_mtl);
  const std::string scene = folder.write("c.obj", corridor_obj), stats = folder.path("s.json");
  const auto render = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"render",   scene,   "-o",      folder.path("o.exr"),
                                   "--size",   "8x6",   "--spp",   "1",
                                   "--method", "fixed", "--stats", stats};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(folder, words);
  };
  CHECK(contains(render({"--eye", "1,1,1", "--target", "9,1,1"}).err, "note: y is up"));
  const auto up = nlohmann::json::parse(read_file(stats))["up"];
  CHECK(up["direction"] == std::vector<double>{0, 1, 0});
  CHECK(up["reason"] == "by a lamp that faces down");
  CHECK(up["doubt"] == "");
  const std::string points = folder.write("p.csv", "x,y,z,nx,ny,nz\n5,1,1,0,1,0\n");
  CHECK(run_program(folder, {"measure", scene, "--points", points}).remarks() == "");
}

TEST_CASE("every command that loads a scene accepts --up") {
  const Folder folder;
  const std::string scene = folder.write("tower.obj", box_obj("20", "20", "60"));
  for (const char* command :
       {"render", "measure", "info", "radiosity", "view", "report", "bake", "convert"}) {
    CAPTURE(command);
    CHECK(contains(run_program(folder, {command, "--help"}).out, "--up"));
  }
  for (const char* bad : {"w", "zz", "0,0,0", "1,2", "", "-"}) {
    const Finished f = run_program(folder, {"info", scene, "--up", bad});
    CAPTURE(bad);
    CHECK(f.status == (std::string(bad).empty() ? 0 : 2));
  }
  CHECK(run_program(folder, {"info", scene, "--up", "zz"}).err ==
        "error: --up: cannot read 'zz': write an axis, such as z or -y, or x,y,z\n");
}

}  // namespace test_up_option
