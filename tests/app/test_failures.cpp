// Failures print one line, return the right status and leave no file behind.
#include <doctest/doctest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <regex>

#include "program.h"

using namespace troffer::test;

namespace test_failures {

namespace {

// Expects exactly one line on standard error, `error: …`, and nothing on standard output.
void check_error(const Finished& f, int status, const std::string& pattern = ".*") {
  CAPTURE(f.err);
  CHECK(f.status == status);
  CHECK(f.out.empty());
  const auto lines = f.error_lines();
  REQUIRE(lines.size() == 1);
  CHECK(std::regex_match(lines[0], std::regex("error: " + pattern)));
}

const std::string place = ":[1-9][0-9]*:[1-9][0-9]*: .+";

}  // namespace

TEST_CASE("broken scenes: file, line and column, exit 1, no output") {
  const std::string gltf = R"({"asset": {"version": "2.0"})";
  const struct {
    const char *name, *text, *where;
  } broken[] = {
      {"a.pbrt", "WorldBegin\nShape \"trianglemesh\" \"integer indices\" [0 1 2", ":2:"},
      {"b.pbrt", "WorldBegin\n\n  \"float\" 3\n", ":3:3:"},
      {"c.pbrt", "WorldBegin\nShape \"sphere\" \"float radius\" [ x ]\n", ":2:"},
      {"d.pbrt", "WorldBegin\nInclude \"missing.pbrt\"\n", ":2:"},
      {"a.gltf", "{\"asset\": {\"version\": \"2.0\"},\n \"meshes\": [ }", ":2:"},
      {"b.gltf", "{\"asset\": {\"version\": \"2.0\"},\n\"extensionsRequired\": [5]}", ":2:"},
      {"c.gltf", "{\"asset\": {\"version\": \"2.0\"},\n\"nodes\": [{\"mesh\": 7}]}", ":2:"},
      {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", ":4:"},
      {"b.obj", "v 0 0 0\nv 1 oops 0\n", ":2:"},
  };
  for (const auto& b : broken) {
    const Folder folder;
    const std::string scene = folder.write(b.name, b.text);
    CAPTURE(b.name);
    for (const std::string command : {"render", "info", "measure"}) {
      std::vector<std::string> arguments{command, scene};
      if (command == "render") arguments.insert(arguments.end(), {"-o", folder.path("out.exr")});
      if (command == "measure")
        arguments.insert(arguments.end(),
                         {"--points", folder.write("p.csv", "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n"), "-o",
                          folder.path("out.csv")});
      const Finished f = run_program(folder, arguments);
      check_error(f, 1, ".*" + std::string(b.name) + place);
      CHECK(f.err.find(b.name + std::string(b.where)) != f.err.npos);
      for (const std::string& name : folder.names()) CHECK((name == b.name || name == "p.csv"));
    }
  }
}

TEST_CASE("missing files, and folders instead of files") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  const std::string out = folder.path("o.exr");
  check_error(run_program(folder, {"render", folder.path("no.pbrt"), "-o", out}), 1);
  check_error(run_program(folder, {"info", folder.path("no.gltf")}), 1);
  check_error(run_program(folder, {"render", folder.path(), "-o", out}), 1);
  check_error(run_program(folder, {"info", folder.write("scene.xyz", "?")}), 1);
  std::filesystem::create_directory(folder.path("folder.pbrt"));
  check_error(run_program(folder, {"render", folder.path("folder.pbrt"), "-o", out}), 1);
  // Opening a pipe would block forever.
  REQUIRE(mkfifo(folder.path("pipe.obj").c_str(), 0600) == 0);
  check_error(run_program(folder, {"render", folder.path("pipe.obj"), "-o", out}), 1);
  check_error(run_program(folder, {"compare", folder.path("a.exr"), folder.path("b.exr")}), 1);
  check_error(run_program(folder, {"measure", scene, "--points", folder.path("no.csv")}), 1);
  CHECK(folder.names() ==
        std::vector<std::string>{"folder.pbrt", "pipe.obj", "room.pbrt", "scene.xyz"});
}

TEST_CASE("outputs that cannot be written are reported before any work and leave nothing behind") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  std::filesystem::create_directory(folder.path("taken.png"));
  const auto before = folder.names();
  // With so many samples the test would time out if rendering began.
  const auto render_to = [&](const std::vector<std::string>& outputs) {
    std::vector<std::string> arguments{"render", scene, "--spp", "1000000"};
    for (const std::string& o : outputs) arguments.insert(arguments.end(), {"-o", o});
    return run_program(folder, arguments);
  };
  check_error(render_to({folder.path("missing/o.exr")}), 1, "cannot write .*missing/o.exr.*");
  check_error(render_to({folder.path("taken.png")}), 1, "cannot write .*taken.png.*");
  check_error(render_to({folder.path("good.exr"), folder.path("missing/o.png")}), 1);
  check_error(render_to({folder.path("picture.tga")}), 2);
  check_error(render_to({folder.path("good.exr"), folder.path("picture")}), 2);
  CHECK(folder.names() == before);
  check_error(run_program(folder, {"render", scene, "-o", folder.path("o.exr"), "--stats",
                                   folder.path("missing/s.json"), "--spp", "1000000"}),
              1);
  CHECK(folder.names() == before);
}

TEST_CASE("a full disk") {
  if (access("/dev/full", W_OK) != 0) {
    MESSAGE("skipped: no /dev/full");
    return;
  }
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  for (const char* name : {"o.exr", "o.png", "o.hdr", "o.pfm"}) {
    CAPTURE(name);
    std::filesystem::create_symlink("/dev/full", folder.path(name));
    check_error(run_program(folder, {"render", scene, "-o", folder.path(name), "--spp", "1"}), 1,
                "cannot write .*");
    std::filesystem::remove(folder.path(name));
    CHECK(folder.names() == std::vector<std::string>{"room.pbrt"});
  }
}

TEST_CASE("a read-only folder") {
  if (geteuid() == 0) return;  // root can write anywhere
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  std::filesystem::create_directory(folder.path("locked"));
  chmod(folder.path("locked").c_str(), 0500);
  check_error(run_program(folder, {"render", scene, "-o", folder.path("locked/o.exr")}), 1);
  chmod(folder.path("locked").c_str(), 0700);
}

TEST_CASE("wrong usage: exit 2") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt), out = folder.path("o.exr");
  const std::vector<std::vector<std::string>> wrong = {
      {"paint"},
      {"render"},
      {"render", scene},
      {"render", scene, "-o", out, "--nonsense"},
      {"render", scene, scene, "-o", out},
      {"render", scene, "-o", out, "--method", "fixed", "--shadow-rays", "0"},
      {"render", scene, "-o", out, "--method", "path", "--solution", "none.trad"},
      {"render", scene, "-o", out, "--method", "kj92", "--select", "nobody"},
      {"render", scene, "-o", out, "--method", "certified", "--error", "0"},
      {"render", scene, "-o", out, "--method", "certified", "--error", "nan"},
      {"render", scene, "-o", out, "--method", "certified", "--indirect", "none", "--solution",
       "s"},
      {"render", scene, "-o", out, "--method", "magic"},
      {"render", scene, "-o", out, "--method", "path", "--indirect", "radiosity"},
      {"render", scene, "-o", out, "--indirect", "perhaps"},
      {"render", scene, "-o", out, "--spp", "0"},
      {"render", scene, "-o", out, "--spp", "-4"},
      {"render", scene, "-o", out, "--spp", "many"},
      {"render", scene, "-o", out, "--shadow-rays", "0"},
      {"render", scene, "-o", out, "--size", "0x10"},
      {"render", scene, "-o", out, "--size", "10"},
      {"render", scene, "-o", out, "--size", "10x"},
      {"render", scene, "-o", out, "--size", "10x10x10"},
      {"render", scene, "-o", out, "--size", "99999999999x2"},
      {"render", scene, "-o", out, "--size", "65536x65536"},
      {"render", scene, "-o", out, "--crop", "0,0,0,0"},
      {"render", scene, "-o", out, "--crop", "0,0,41,30"},
      {"render", scene, "-o", out, "--crop", "0,0,9"},
      {"render", scene, "-o", out, "--aov", "shininess"},
      {"render", scene, "-o", out, "--camera", "nobody"},
      {"render", scene, "-o", out, "--light", "sun"},
      {"render", scene, "-o", out, "--light", "emitter0,sun"},
      {"render", scene, "-o", out, "--eye", "0,0,1"},
      {"render", scene, "-o", out, "--eye", "0,0,1", "--target", "0,0"},
      {"render", scene, "-o", out, "--eye", "0,0,1", "--target", "0,0,1"},
      {"render", scene, "-o", out, "--eye", "1e30,0,1", "--target", "0,0,1"},
      {"render", scene, "-o", out, "--eye", "0,0,1", "--target", "0,1,1", "--fov", "nan"},
      {"render", scene, "-o", out, "--exposure", "nan"},
      {"render", scene, "-o", out, "--threads", "0"},
      {"render", scene, "-o", out, "--depth", "-1"},
      {"measure", scene},
      {"measure", scene, "--points", scene, "--method", "certified", "--error", "-1"},
      {"compare", out},
      {"info"},
  };
  for (const auto& arguments : wrong) {
    std::string line;
    for (const std::string& a : arguments) line += a + " ";
    CAPTURE(line);
    check_error(run_program(folder, arguments), 2);
  }
  CHECK(folder.names() == std::vector<std::string>{"room.pbrt"});
}

TEST_CASE("help and version are no failures") {
  const Folder folder;
  for (const char* word : {"--help", "--version"}) {
    const Finished f = run_program(folder, {word});
    CHECK(f.status == 0);
    CHECK(f.err.empty());
    CHECK(f.out.find("troffer") != f.out.npos);
  }
  const Finished f = run_program(folder, {"render", "--help"});
  CHECK(f.status == 0);
  CHECK(f.out.find("--spp") != f.out.npos);
}

TEST_CASE("point lists that cannot be read name line and column") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  const struct {
    const char *text, *where;
  } broken[] = {{"", ":1:1:"},
                {"x,y,z,nx,ny\n0,0,0,0,0\n", ":1:1:"},
                {"x,y,z,nx,ny,nz\n0,0,0,0,0,1\n0,0,zero,0,0,1\n", ":3:5:"},
                {"x,y,z,nx,ny,nz\n0,0,0,0,0\n", ":2:10:"},
                {"x,y,z,nx,ny,nz\n\n0,0,0, 0,0,0\n", ":3:8:"},
                {"x,y,z,nx,ny,nz\n0,0,nan,0,0,1\n", ":2:5:"},
                {"x,y,z,nx,ny,nz\n0,0,1e99,0,0,1\n", ":2:5:"},
                {"x,y,z,nx,ny,nz\n0,0,1e30,0,0,1\n", ":2:1:"},
                {"x,y,z,nx,ny,nz\n0,0,0,1e30,0,1\n", ":2:7:"}};
  for (const auto& b : broken) {
    const std::string points = folder.write("points.csv", b.text);
    CAPTURE(b.text);
    const Finished f =
        run_program(folder, {"measure", scene, "--points", points, "-o", folder.path("o.csv")});
    check_error(f, 1, ".*points.csv" + place);
    CHECK(f.err.find(b.where) != f.err.npos);
  }
  CHECK(folder.names() == std::vector<std::string>{"points.csv", "room.pbrt"});
}

TEST_CASE("cameras out of range are refused") {
  const Folder folder;
  const std::string text = lit_floor_pbrt;
  const std::string body = text.substr(text.find("WorldBegin"));
  const std::string cameras[] = {
      "LookAt 1e30 0 0  0 0 0  0 0 1\nCamera \"perspective\"\n",
      "Camera \"orthographic\" \"float screenwindow\" [-1e30 1e30 -1e30 1e30]\n",
      "Camera \"perspective\" \"float screenwindow\" [-3e38 3e38 -3e38 3e38]\n",
      "Camera \"perspective\" \"float lensradius\" [1e30] \"float focaldistance\" [1e-30]\n"};
  for (const std::string& camera : cameras) {
    CAPTURE(camera);
    const std::string scene = folder.write("far.pbrt", camera + body);
    check_error(run_program(folder, {"render", scene, "-o", folder.path("o.exr"), "--spp", "1"}),
                1);
    CHECK(folder.names() == std::vector<std::string>{"far.pbrt"});
  }
}

TEST_CASE("printing to a full disk is a failure") {
  if (access("/dev/full", W_OK) != 0) return;
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  const std::string command =
      std::string(TROFFER_PROGRAM) + " info " + scene + " > /dev/full 2> " + folder.path("err");
  CHECK(WEXITSTATUS(std::system(command.c_str())) == 1);
  CHECK(read_file(folder.path("err")).rfind("error: ", 0) == 0);
}

}  // namespace test_failures
