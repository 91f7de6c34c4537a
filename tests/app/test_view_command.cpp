// `troffer view` from its start to its end.
#include <doctest/doctest.h>
#include <signal.h>

#include "program.h"

using namespace troffer::test;

TEST_CASE("view tells its address, and a signal ends it") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  for (const int which : {SIGINT, SIGTERM}) {
    Running program(folder, {"view", scene, "--threads", "1", "--error", "0.001"});
    program.let_work(0.5);
    program.send(which);
    const Finished f = program.wait();
    CHECK(f.status == 130);
    CHECK(f.seconds_after_signal < 5);
    CHECK(f.err.empty());
    CHECK(f.out.rfind("http://127.0.0.1:", 0) == 0);
    CHECK(f.out.size() > 32 + 20);
  }
  CHECK(folder.names() == std::vector<std::string>{"room.pbrt"});
}

TEST_CASE("view refuses what it cannot show, before any page is there") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  const auto run = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"view"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Finished f = run_program(folder, arguments);
    CHECK(f.out.empty());
    CHECK(f.error_lines().size() == 1);
    return f.status;
  };
  CHECK(run({folder.path("none.gltf")}) == 1);
  CHECK(run({scene, "--camera", "none"}) == 2);
  CHECK(run({scene, "--size", "0x10"}) == 2);
  CHECK(run({scene, "--size", "10x10x"}) == 2);
  CHECK(run({scene, "--error", "nan"}) == 2);
  CHECK(run({scene, "--method", "magic"}) == 2);
  CHECK(run({scene, "--tev", "nobody"}) != 0);
  CHECK(run({scene, "--tev", "127.0.0.1:x"}) == 2);
  CHECK(run({scene, "--at", "48,16,yesterday"}) == 2);
}
