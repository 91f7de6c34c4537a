// The command `troffer bake`: files, options, exit statuses.
#include <doctest/doctest.h>
#include <signal.h>

#include <algorithm>
#include <string>

#include "image/read_image.h"
#include "import/import.h"
#include "program.h"

using namespace troffer;
using namespace troffer::test;

namespace test_bake_command {

TEST_CASE("bake writes the scene with its light, the same for any number of threads") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  const Finished f = run_program(folder, {"bake", scene, "-o", folder.path("a.gltf"),
                                          "--resolution", "64", "--spp", "16", "--threads", "1"});
  CAPTURE(f.err);
  CHECK(f.status == 0);
  CHECK(f.out.find("1 page of 64 x 64 texels") != std::string::npos);
  CHECK(f.out.find("mean illuminance") != std::string::npos);
  CHECK(folder.names() == std::vector<std::string>{"a.gltf", "a_files", "room.pbrt"});
  const std::string text = read_file(folder.path("a.gltf"));
  for (const char* word : {"MOZ_lightmap", "\"unit\": \"lx\"", "a_files/light0.exr"})
    CHECK(text.find(word) != std::string::npos);
  CHECK(read_image(folder.path("a_files/light0.exr")).width == 64);
  const std::string data = read_file(folder.path("a_files/data.bin"));
  const std::string page = read_file(folder.path("a_files/light0.exr"));
  const Finished again =
      run_program(folder, {"bake", scene, "-o", folder.path("a.gltf"), "--resolution", "64",
                           "--spp", "16", "--threads", "2", "--quiet"});
  CHECK(again.status == 0);
  CHECK(again.out.empty());
  CHECK(again.err.empty());
  CHECK(read_file(folder.path("a.gltf")) == text);
  CHECK(read_file(folder.path("a_files/data.bin")) == data);
  CHECK(read_file(folder.path("a_files/light0.exr")) == page);
}

TEST_CASE("bake writes one kind of result at a time, with the requested texel size") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  for (const char* kind : {"--unlit", "--emissive", "--vertex-colours"}) {
    const Finished f = run_program(folder, {"bake", scene, "-o", folder.path("a.glb"), "--spp", "4",
                                            "--texels-per-metre", "3", "--hdr", "none", kind});
    CAPTURE(kind);
    CAPTURE(f.err);
    CHECK(f.status == 0);
    CHECK(folder.names() == std::vector<std::string>{"a.glb", "room.pbrt"});
    CHECK(triangle_count(import_scene(folder.path("a.glb"))) > 0);
  }
  const auto refused = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"bake", scene});
    const Finished f = run_program(folder, arguments);
    CHECK(f.error_lines().size() == 1);
    return f.status;
  };
  const std::string out = folder.path("b.glb");
  CHECK(refused({"-o", out, "--unlit", "--emissive"}) == 2);
  CHECK(refused({"-o", folder.path("b.pbrt")}) == 2);
  CHECK(refused({"-o", out, "--resolution", "64", "--texels-per-metre", "9"}) == 2);
  CHECK(refused({"-o", out, "--texels-per-metre", "nan"}) == 2);
  CHECK(refused({"-o", out, "--texels-per-metre", "90000"}) == 2);
  CHECK(refused({"-o", out, "--exposure", "bright"}) == 2);
  CHECK(refused({"-o", folder.path("none/b.glb")}) == 1);
  CHECK(folder.names() == std::vector<std::string>{"a.glb", "room.pbrt"});
}

TEST_CASE("a signal stops baking, and nothing is left behind") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  Running program(folder, {"bake", scene, "-o", folder.path("a.gltf"), "--resolution", "2048",
                           "--spp", "4096", "--threads", "1"});
  program.let_work(1);
  program.send(SIGINT);
  const Finished f = program.wait();
  CHECK(f.status == 130);
  CHECK(f.seconds_after_signal < 5);
  CHECK(folder.names() == std::vector<std::string>{"room.pbrt"});
}

}  // namespace test_bake_command
