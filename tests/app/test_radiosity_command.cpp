// The command `troffer radiosity`: files, options, exit statuses.
#include <doctest/doctest.h>
#include <signal.h>

#include <string>

#include "base/error.h"
#include "import/import.h"
#include "program.h"
#include "render/radiosity.h"

using namespace troffer;
using namespace troffer::test;

namespace test_radiosity_command {

namespace {

std::vector<uint8_t> bytes_of(const std::string& path) {
  const std::string text = troffer::test::read_file(path);
  return {text.begin(), text.end()};
}

// Returns why a file is refused for a scene with these options; empty if it is accepted.
std::string refusal(const std::string& scene_path, const std::string& solution,
                    const RadiosityOptions* options) {
  const PreparedScene scene(import_scene(scene_path));
  try {
    load_radiosity(scene, bytes_of(solution), solution, options, 2);
  } catch (const InputError& e) {
    return e.reason();
  }
  return "";
}

}  // namespace

TEST_CASE("radiosity writes a solution and a displayable mesh, and prints a summary") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  const Finished f = run_program(
      folder, {"radiosity", scene, "-o", folder.path("a.trad"), "-o", folder.path("a.gltf"), "-o",
               folder.path("a.glb"), "--stats", folder.path("s.json"), "--element-size", "0.5"});
  CAPTURE(f.err);
  CHECK(f.status == 0);
  CHECK(f.out.find("elements") != std::string::npos);
  CHECK(f.out.find("shots") != std::string::npos);
  CHECK(f.out.find("absorbed") != std::string::npos);
  CHECK(folder.names() ==
        std::vector<std::string>{"a.glb", "a.gltf", "a.trad", "room.pbrt", "s.json"});
  CHECK(troffer::test::read_file(folder.path("s.json")).find("\"is_complete\": true") !=
        std::string::npos);
  const size_t triangles = triangle_count(import_scene(folder.path("a.gltf")));
  CHECK(triangles > 50);
  CHECK(triangles == triangle_count(import_scene(folder.path("a.glb"))));
  CHECK(refusal(scene, folder.path("a.trad"), nullptr).empty());

  const Finished again =
      run_program(folder, {"radiosity", scene, "-o", folder.path("b.trad"), "--element-size", "0.5",
                           "--threads", "1", "--quiet"});
  CHECK(again.status == 0);
  CHECK(again.out.empty());
  CHECK(again.err.empty());
  CHECK(bytes_of(folder.path("a.trad")) == bytes_of(folder.path("b.trad")));
}

TEST_CASE("a solution of another scene or of other settings is refused") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  std::string text = lit_floor_pbrt;
  text.replace(text.find("[5 5 5]"), 7, "[5 5 4]");
  const std::string other = folder.write("other.pbrt", text);
  const std::string file = folder.path("a.trad");
  REQUIRE(run_program(folder, {"radiosity", scene, "-o", file, "--unshot", "0.1"}).status == 0);
  RadiosityOptions options;
  options.unshot_fraction = 0.1f;
  CHECK(refusal(scene, file, &options).empty());
  CHECK(refusal(other, file, &options).find("another scene") != std::string::npos);
  options.unshot_fraction = 0.2f;
  CHECK(refusal(scene, file, &options).find("unshot fraction") != std::string::npos);
  CHECK(refusal(scene, scene, nullptr).find("not a radiosity solution") != std::string::npos);
}

TEST_CASE("radiosity: wrong options and impossible files are refused") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  const std::string out = folder.path("a.trad");
  const auto status = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"radiosity", scene, "-o", out});
    const Finished f = run_program(folder, more);
    CAPTURE(f.err);
    CHECK(f.error_lines().size() == 1);
    CHECK(f.err.rfind("error: ", 0) == 0);
    return f.status;
  };
  CHECK(status({"--element-size", "-1"}) == 2);
  CHECK(status({"--element-size", "nan"}) == 2);
  CHECK(status({"--patch-size", "0"}) == 2);
  CHECK(status({"--element-size", "1", "--patch-size", "0.5"}) == 2);
  CHECK(status({"--stored", "65"}) == 2);
  CHECK(status({"--stored", "-1"}) == 2);
  CHECK(status({"--unshot", "0"}) == 2);
  CHECK(status({"--unshot", "nan"}) == 2);
  CHECK(status({"--light", "nobody"}) == 2);
  CHECK(status({"-o", out}) == 2);
  CHECK(status({"-o", folder.path("a.png")}) == 2);
  CHECK(status({"-o", folder.path("none/a.trad")}) == 1);
  CHECK(status({"--stats", folder.path("none/s.json")}) == 1);
  CHECK(folder.names() == std::vector<std::string>{"room.pbrt"});
  CHECK(run_program(folder, {"radiosity", folder.path("no.pbrt"), "-o", out}).status == 1);
  CHECK(run_program(folder, {"radiosity", scene}).status == 2);
}

TEST_CASE("radiosity stops at a signal and writes its unfinished solution intact") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", bright_room_pbrt());
  Running program(folder, {"radiosity", scene, "-o", folder.path("a.trad"), "-o",
                           folder.path("a.glb"), "--stats", folder.path("s.json"), "--unshot",
                           "0.000001", "--element-size", "0.04", "--threads", "1"});
  program.let_work(1);
  program.send(SIGINT);
  const Finished f = program.wait();
  CAPTURE(f.err);
  CHECK(f.status == 130);
  CHECK(f.seconds_after_signal < 10);
  CHECK(f.err.find("interrupted after ") != std::string::npos);
  CHECK(f.err.find(" shots: wrote " + folder.path("a.trad") + ", ") != std::string::npos);
  CHECK(folder.names() == std::vector<std::string>{"a.glb", "a.trad", "room.pbrt", "s.json"});
  CHECK(refusal(scene, folder.path("a.trad"), nullptr).find("was interrupted after") !=
        std::string::npos);
  const Finished refused =
      run_program(folder, {"render", scene, "-o", folder.path("o.exr"), "--method", "kj92",
                           "--solution", folder.path("a.trad")});
  CHECK(refused.status == 1);
  CHECK(refused.err.find("was interrupted after") != std::string::npos);
  const Finished other = run_program(
      folder, {"render", scene, "-o", folder.path("o.exr"), "--solution", folder.path("a.trad")});
  CHECK(other.status == 1);
  CHECK(other.err.find("--method kj92") != std::string::npos);
  CHECK(triangle_count(import_scene(folder.path("a.glb"))) > 1000);
  CHECK(troffer::test::read_file(folder.path("s.json")).find("\"is_complete\": false") !=
        std::string::npos);
}

}  // namespace test_radiosity_command
