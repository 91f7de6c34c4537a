// SIGINT and SIGTERM at random moments of every command. An existing output is either unchanged or
// what an uninterrupted run writes, and the program reports correctly what it has left.
// TROFFER_STOPS=1000 test_app --source-file='*/test_stops.cpp' stops each command 1000 times.
#include <doctest/doctest.h>
#include <signal.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>

#include "image/read_image.h"
#include "program.h"

using namespace troffer;
using namespace troffer::test;

namespace test_stops {

namespace {

using Words = std::vector<std::string>;
namespace fs = std::filesystem;

Words operator+(Words a, const Words& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

int stops() {
  const char* asked = std::getenv("TROFFER_STOPS");
  return asked != nullptr ? std::atoi(asked) : 48;
}

// A command, and the files that it writes into the folder.
struct Command {
  Words words, outputs;
  bool is_exact = true;  // each run writes the same bytes
};

struct Count {
  int stopped = 0, done = 0, left = 0;
};

// Checks that every file an interrupted run left is reported and complete.
void check_left(const Folder& folder, const Finished& f, Count& count) {
  for (const auto& entry : fs::recursive_directory_iterator(folder.path())) {
    const std::string name = entry.path().string();
    CAPTURE(name);
    CHECK(!contains(name, ".tmp"));
    if (!contains(name, ".partial")) continue;
    ++count.left;
    CHECK(contains(f.err, name));
    if (entry.path().extension() == ".exr" || entry.path().extension() == ".pfm") {
      const Image image = read_image(name);
      CHECK(std::any_of(image.pixels.begin(), image.pixels.end(),
                        [](const Rgb& p) { return !p.is_black(); }));
    } else {
      CHECK(!read_file(name).empty());
    }
    fs::remove(entry.path());
  }
}

void check_outputs(const Command& c, const Finished& f, const std::vector<std::string>& wanted) {
  for (size_t i = 0; i < c.outputs.size(); ++i) {
    CAPTURE(c.outputs[i]);
    const std::string now = read_file(c.outputs[i]);
    if (f.status != 0)
      CHECK(now == "mine");
    else if (c.is_exact)
      CHECK(now == wanted[i]);
    else
      CHECK(now != "mine");
  }
}

// Stops the command at random moments, with and without existing outputs.
void stop_often(const Folder& folder, const Command& c, std::mt19937& random) {
  const Finished whole = run_program(folder, c.words);
  CAPTURE(whole.err);
  REQUIRE(whole.status == 0);
  std::vector<std::string> wanted;
  for (const std::string& o : c.outputs) wanted.push_back(read_file(o));
  Count count;
  for (int i = 0; i < stops(); ++i) {
    const bool is_new = i % 4 == 3;
    for (const std::string& o : c.outputs)
      if (is_new)
        fs::remove(o);
      else
        std::ofstream(o) << "mine";
    Running program(folder, c.words);
    program.let_work(whole.processor_seconds * 1.1 * double(random()) / 4294967296.0);
    program.send(i % 2 == 0 ? SIGINT : SIGTERM);
    const Finished f = program.wait();
    CAPTURE(f.err);
    // A SIGINT before the handlers are installed ends the process silently, with the same status.
    const bool is_stopped = f.status == 130 && !f.err.empty();
    CHECK((is_stopped || f.status == 0 || f.status == 128 + SIGINT || f.status == 128 + SIGTERM));
    ++(f.status == 0 ? count.done : count.stopped);
    if (is_stopped) CHECK(contains(f.err, "interrupted"));
    check_left(folder, f, count);
    if (!is_new) check_outputs(c, f, wanted);
    if (is_new && is_stopped)  // every remaining file is mentioned
      for (const std::string& o : c.outputs)
        if (fs::exists(o)) CHECK(contains(f.err, o));
  }
  CHECK(count.stopped > stops() / 4);
  MESSAGE(c.words[0] << ": " << count.stopped << " stopped, " << count.done << " done, "
                     << count.left << " unfinished files beside the old ones");
}

const char* const points_csv =
    "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n1,0,0,0,0,1\n-1,0,0,0,0,1\n0,1,0,0,0,1\n";

}  // namespace

TEST_CASE("a picture is only replaced by a complete one, whenever rendering is stopped") {
  std::mt19937 random(3);
  for (const Words& more :
       {Words{"--method", "path", "--spp", "64"}, Words{"--error", ".3", "--preview"}}) {
    const Folder folder;
    const std::string scene = folder.write("room.pbrt", lit_floor_pbrt),
                      picture = folder.path("o.exr"), second = folder.path("o.pfm");
    stop_often(folder,
               {Words{"render", scene, "-o", picture, "-o", second, "--size", "24x18", "--threads",
                      "1", "--aov", "normal"} +
                    more,
                {picture, second}},
               random);
  }
}

TEST_CASE("statistics of a stopped rendering are written beside those of a complete one") {
  std::mt19937 random(4);
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt), json = folder.path("s.json");
  stop_often(folder,
             {{"render", scene, "-o", "/dev/stdout", "--stats", json, "--size", "24x18", "--method",
               "path", "--spp", "64", "--threads", "1"},
              {json},
              false},
             random);
}

TEST_CASE("measured values are only replaced by those of all points") {
  std::mt19937 random(5);
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt),
                    points = folder.write("p.csv", points_csv), out = folder.path("o.csv");
  stop_often(folder,
             {{"measure", scene, "--points", points, "-o", out, "--spp", "2000", "--method", "path",
               "--threads", "1"},
              {out}},
             random);
}

TEST_CASE("a solution is only replaced by a finished one; an unfinished one is refused") {
  std::mt19937 random(6);
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", bright_room_pbrt()),
                    out = folder.path("a.trad"), shown = folder.path("a.glb");
  stop_often(folder,
             {{"radiosity", scene, "-o", out, "-o", shown, "--element-size", ".5", "--unshot",
               ".001", "--threads", "1"},
              {out, shown}},
             random);
}

TEST_CASE("a report, a baked scene and a converted scene are replaced as a whole") {
  std::mt19937 random(7);
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", bright_room_pbrt());
  const std::string report = folder.path("report");
  fs::create_directory(report);
  stop_often(folder,
             {{"report", scene, "-o", report, "--pictures", "off", "--spp", "4", "--contributions",
               "off", "--daylight-factor", "off", "--method", "path", "--threads", "1"},
              {report + "/report.html", report + "/report.json", report + "/points.csv"}},
             random);
  const std::string baked = folder.path("b.glb"), converted = folder.path("c.gltf");
  stop_often(folder,
             {{"bake", scene, "-o", baked, "--hdr", "none", "--resolution", "16", "--spp", "4",
               "--method", "path", "--threads", "1"},
              {baked}},
             random);
  stop_often(folder, {{"convert", scene, converted}, {converted}}, random);
}

TEST_CASE("a merged picture is replaced as a whole") {
  std::mt19937 random(8);
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt), out = folder.path("o.exr");
  Words merge{"merge", out};
  for (const std::string part : {"1/2", "2/2"}) {
    merge.push_back(folder.path("part" + part.substr(0, 1) + ".exr"));
    REQUIRE(run_program(folder, {"render", scene, "-o", merge.back(), "--part", part, "--method",
                                 "fixed", "--spp", "1"})
                .status == 0);
  }
  stop_often(folder, {merge, {out}}, random);
}

TEST_CASE("view can be stopped at any moment and leaves nothing behind") {
  std::mt19937 random(9);
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  for (int i = 0; i < stops(); ++i) {
    Running program(folder, {"view", scene, "--size", "16x12", "--threads", "1"});
    program.let_work(.1 * double(random()) / 4294967296.0);
    program.send(i % 2 == 0 ? SIGINT : SIGTERM);
    const Finished f = program.wait();
    CAPTURE(f.err);
    CHECK((f.status == 130 || f.status == 128 + SIGINT || f.status == 128 + SIGTERM));
    CHECK(folder.names() == Words{"room.pbrt"});
  }
}

TEST_CASE("a time limit at any moment leaves a picture without black pixels") {
  std::mt19937 random(10);
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", bright_room_pbrt()),
                    out = folder.path("o.pfm");
  for (int i = 0; i < stops() / 4; ++i) {
    folder.write("o.pfm", "mine");
    const double seconds = .001 + .1 * double(random()) / 4294967296.0;
    const Finished f =
        run_program(folder, {"render", scene, "-o", out, "--size", "24x18", "--time-limit",
                             std::to_string(seconds), "--threads", "1"});
    CAPTURE(f.err);
    CHECK(f.status == 0);
    const Image image = read_image(out);
    CHECK(std::none_of(image.pixels.begin(), image.pixels.end(),
                       [](const Rgb& p) { return p.is_black(); }));
  }
}

}  // namespace test_stops
