// `render` and `measure` with --method kj92: options, files, exit statuses.
#include <doctest/doctest.h>

#include <signal.h>

#include <fstream>
#include <string>

#include "image/read_image.h"
#include "program.h"

using namespace troffer;
using namespace troffer::test;

namespace test_kj92_command {

namespace {

// Returns the number after "name": in a JSON file; -1 if missing.
double number_in(const std::string& json, const std::string& name) {
  const size_t at = json.find("\"" + name + "\":");
  return at == std::string::npos ? -1 : std::stod(json.substr(at + name.size() + 3));
}

std::vector<std::string> render_of(const Folder& folder, const std::string& scene,
                                   std::vector<std::string> more) {
  more.insert(more.begin(),
              {"render", scene, "-o", folder.path("o.exr"), "--method", "kj92", "--quiet"});
  return more;
}

}  // namespace

TEST_CASE("kj92: every option is accepted") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  REQUIRE(run_program(folder, {"radiosity", scene, "-o", folder.path("a.trad"), "--element-size",
                               "0.5", "--quiet"})
              .status == 0);
  const std::vector<std::vector<std::string>> all{
      {},
      {"--variance", "0.05", "--shadow-rays", "16", "--most-rays", "64"},
      {"--variance", "0", "--most-rays", "4"},
      {"--mean-change", "0", "--level-difference", "3", "--probe-rays", "2"},
      {"--coherence", "off"},
      {"--coherence", "on", "--selection", "off", "--ratio"},
      {"--select", "emitter0"},
      {"--shadow-rays", "0"},
      {"--indirect", "none"},
      {"--indirect", "radiosity"},
      {"--max-spp", "16", "--spp", "2"},
      {"--max-spp", "1"},
      {"--aov", "direct,indirect,shadow_rays,sources,error,albedo,normal,depth,position"}};
  for (std::vector<std::string> options : all) {
    const std::string first = options.empty() ? "" : options[0] + " " + options[1];
    options.insert(options.end(), {"--size", "16x12", "--solution", folder.path("a.trad")});
    const Finished f = run_program(folder, render_of(folder, scene, options));
    CAPTURE(first);
    CAPTURE(f.err);
    CHECK(f.status == 0);
    CHECK(f.remarks().empty());
    const Image image = read_image(folder.path("o.exr"));
    CHECK(image.width == 16);
    double sum = 0;
    for (const Rgb& p : image.pixels) sum += double(p.g);
    CHECK(sum > 0);
  }
}

TEST_CASE("kj92: wrong values are usage errors, in one line") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  for (const std::vector<std::string>& options :
       std::vector<std::vector<std::string>>{{"--variance", "-1"},
                                             {"--variance", "nan"},
                                             {"--variance", "much"},
                                             {"--mean-change", "2"},
                                             {"--mean-change", "nan"},
                                             {"--most-rays", "0"},
                                             {"--most-rays", "70000"},
                                             {"--level-difference", "25"},
                                             {"--level-difference", "-1"},
                                             {"--probe-rays", "0"},
                                             {"--coherence", "perhaps"},
                                             {"--selection", "perhaps"},
                                             {"--select", "nobody"},
                                             {"--max-spp", "0"},
                                             {"--shadow-rays", "-3"},
                                             {"--aov", "source"}}) {
    const Finished f = run_program(folder, render_of(folder, scene, options));
    CAPTURE(options[0]);
    CAPTURE(options[1]);
    CAPTURE(f.err);
    CHECK(f.status == 2);
    CHECK(f.error_lines().size() == 1);
    CHECK(f.err.rfind("error: ", 0) == 0);
  }
  CHECK(folder.names() == std::vector<std::string>{"room.pbrt"});
  // Options that other methods refuse.
  for (const std::vector<std::string>& options : std::vector<std::vector<std::string>>{
           {"--solution", scene}, {"--indirect", "radiosity"}, {"--shadow-rays", "0"}}) {
    const Finished f = run_program(folder, {"render", scene, "-o", folder.path("o.exr"), "--method",
                                            "path", options[0], options[1]});
    CHECK(f.status == 2);
  }
}

TEST_CASE("kj92: a solution of another scene is refused in one line") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  std::string text = lit_floor_pbrt;
  text.replace(text.find("[5 5 5]"), 7, "[5 5 4]");
  const std::string other = folder.write("other.pbrt", text), file = folder.path("a.trad");
  REQUIRE(run_program(folder, {"radiosity", other, "-o", file, "--quiet"}).status == 0);
  const std::string whole = troffer::test::read_file(file);
  folder.write("cut.trad", whole.substr(0, whole.size() / 2));
  for (const char* name : {"a.trad", "cut.trad", "room.pbrt", "none.trad"}) {
    const Finished f =
        run_program(folder, render_of(folder, scene, {"--solution", folder.path(name)}));
    CAPTURE(f.err);
    CHECK(f.status == 1);
    CHECK(f.error_lines().size() == 1);
    CHECK(f.err.rfind("error: ", 0) == 0);
  }
  for (const std::string& n : folder.names()) CHECK(n != "o.exr");
  // A solution of the same scene is accepted and gives the same picture as computing it.
  CHECK(run_program(folder, render_of(folder, other, {"--solution", file})).status == 0);
  const Image loaded = read_image(folder.path("o.exr"));
  CHECK(run_program(folder, render_of(folder, other, {})).status == 0);
  CHECK(read_image(folder.path("o.exr")).pixels == loaded.pixels);
}

TEST_CASE("kj92: statistics hold the preprocessing time; 'sources' is a layer") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  const Finished f = run_program(
      folder, render_of(folder, scene, {"--stats", folder.path("s.json"), "--aov", "sources"}));
  CHECK(f.status == 0);
  const std::string json = troffer::test::read_file(folder.path("s.json"));
  CHECK(number_in(json, "preprocess") > 0);
  CHECK(number_in(json, "render") > 0);
  CHECK(number_in(json, "shadow_rays") > 0);
  CHECK(number_in(json, "viewing_rays") == 40 * 30 * 4);
  CHECK(json.find("\"method\": \"kj92\"") != std::string::npos);
  CHECK(troffer::test::read_file(folder.path("o.exr")).find("sources.") != std::string::npos);
}

TEST_CASE("kj92: measure, with and without a solution") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  const std::string points = folder.write("p.csv", "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n1,0,0,0,0,1\n");
  REQUIRE(
      run_program(folder, {"radiosity", scene, "-o", folder.path("a.trad"), "--quiet"}).status ==
      0);
  std::vector<std::string> words{"measure",  scene,  "--points", points, "-o", folder.path("o.csv"),
                                 "--method", "kj92", "--quiet"};
  CHECK(run_program(folder, words).status == 0);
  const std::string first = troffer::test::read_file(folder.path("o.csv"));
  CHECK(first.find("illuminance_lx") != std::string::npos);
  words.insert(words.end(), {"--solution", folder.path("a.trad")});
  CHECK(run_program(folder, words).status == 0);
  CHECK(troffer::test::read_file(folder.path("o.csv")) == first);
}

TEST_CASE("kj92: SIGINT leaves a picture during rendering and nothing during radiosity") {
  for (const bool is_during_radiosity : {true, false})
    for (const int which : {SIGINT, SIGTERM}) {
      const Folder folder;
      const std::string scene =
          folder.write("room.pbrt", is_during_radiosity ? bright_room_pbrt() : lit_floor_pbrt);
      std::vector<std::string> options{"--threads", "1", "--stats", folder.path("s.json")};
      if (is_during_radiosity) {
        // Walls of 95 % make the solution slow; a loaded machine only makes it slower.
        options.insert(options.end(), {"--size", "40x30", "--spp", "100000"});
      } else {
        options.insert(options.end(), {"--spp", "1000000"});
      }
      Running program(folder, render_of(folder, scene, options));
      program.let_work(is_during_radiosity ? 0.4 : 2.5);
      program.send(which);
      const Finished f = program.wait();
      CAPTURE(is_during_radiosity);
      CAPTURE(f.err);
      CHECK(f.status == 130);
      CHECK(f.seconds_after_signal < 8);
      if (is_during_radiosity) {  // no pixel has a sample yet
        CHECK(f.err.find("before the first pixel was finished") != std::string::npos);
        CHECK(!std::ifstream(folder.path("o.exr")));
        continue;
      }
      const Image image = read_image(folder.path("o.exr"));
      CHECK(image.width == 40);
      CHECK(troffer::test::read_file(folder.path("s.json")).find("\"is_complete\": false") !=
            std::string::npos);
    }
}

}  // namespace test_kj92_command
