// Outputs that are no plain files, that cannot grow, or that a signal cuts short.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <thread>

#include "program.h"

using namespace troffer::test;

namespace test_outputs {

namespace {

void limit_files_to(rlim_t bytes) {
  const rlimit limit{bytes, bytes};
  setrlimit(RLIMIT_FSIZE, &limit);
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

const char* const points_csv = "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n1,0,0,0,0,1\n";

}  // namespace

TEST_CASE("a pipe without a reader is reported before any work") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt), pipe = folder.path("o.exr");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  // With so many samples the test would time out if rendering began.
  const Finished f = run_program(folder, {"render", scene, "-o", pipe, "--spp", "1000000"});
  CHECK(f.status == 1);
  CHECK(f.err == "error: cannot write " + pipe + ": nobody reads from this pipe\n");
}

TEST_CASE("a reader of a pipe gets the same picture as a file") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  const std::string pipe = folder.path("p.pfm"), file = folder.path("o.pfm");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  std::string got;
  std::thread reader([&] { got = read_file(pipe); });
  const Finished f = run_program(folder, {"render", scene, "-o", pipe, "-o", file, "--spp", "1"});
  reader.join();
  CAPTURE(f.err);
  CHECK(f.status == 0);
  CHECK(got.size() > 40 * 30 * 12);
  CHECK(got == read_file(file));
  CHECK(folder.names() == std::vector<std::string>{"o.pfm", "p.pfm", "room.pbrt"});
}

TEST_CASE("-o /dev/stdout adds to the file that standard output goes to") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  const std::string points = folder.write("p.csv", points_csv);
  const auto measure = [&](const std::string& out, const std::string& redirected) {
    const auto append = [&] {
      if (!redirected.empty()) dup2(open(redirected.c_str(), O_WRONLY | O_APPEND), STDOUT_FILENO);
    };
    return Running(folder,
                   {"measure", scene, "--points", points, "--spp", "4", "-o", out, "--quiet",
                    "--method", "fixed"},
                   append)
        .wait();
  };
  CHECK(measure(folder.path("o.csv"), "").status == 0);
  const std::string csv = read_file(folder.path("o.csv"));
  CHECK(contains(csv, "illuminance_lx"));
  const Finished plain = measure("/dev/stdout", "");
  CHECK(plain.status == 0);
  CHECK(plain.out == csv);
  // `>>` keeps the contents and the identity of the file.
  const std::string log = folder.write("log", "mine\n");
  struct stat before {
  }, after{};
  REQUIRE(stat(log.c_str(), &before) == 0);
  CHECK(measure("/dev/stdout", log).status == 0);
  CHECK(read_file(log) == "mine\n" + csv);
  REQUIRE(stat(log.c_str(), &after) == 0);
  CHECK(before.st_ino == after.st_ino);
}

TEST_CASE("a limit on file size: exit status 1, one line, nothing left behind") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  for (const char* name : {"o.exr", "o.pfm", "o.hdr"}) {
    const Finished f =
        Running(folder,
                {"render", scene, "-o", folder.path(name), "--spp", "1", "--method", "fixed"},
                [] { limit_files_to(1024); })
            .wait();
    CAPTURE(f.err);
    CHECK(f.status == 1);
    CHECK(f.err == "error: cannot write " + folder.path(name) + ": File too large\n");
    CHECK(folder.names() == std::vector<std::string>{"room.pbrt"});
  }
  const Finished printed =
      Running(folder, {"info", scene, "--json"}, [] { limit_files_to(64); }).wait();
  CHECK(printed.status == 1);
  CHECK(printed.err == "error: cannot write to standard output\n");
}

TEST_CASE("a second signal during writing leaves no temporary file") {
  const Folder folder;
  // Nearly nothing to render, but a large picture to write.
  const std::string scene = folder.write("empty.pbrt",
                                         "Camera \"perspective\"\nWorldBegin\n"
                                         "Shape \"sphere\" \"float radius\" [0.001]\n");
  Running program(folder, {"render", scene, "-o", folder.path("o.exr"), "--size", "2000x1500",
                           "--spp", "1", "--method", "path", "--depth", "0", "--threads", "1",
                           "--aov", "normal,position,depth", "--quiet"});
  const auto is_writing = [&] {
    for (const std::string& name : folder.names())
      if (contains(name, ".tmp")) return true;
    return false;
  };
  program.let_work(0.3);  // past the check that it can be written
  while (!is_writing() && folder.names().size() == 1)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  CHECK(is_writing());
  program.send(SIGINT);
  program.send(SIGINT);
  program.send(SIGTERM);
  CHECK(program.wait().status == 130);
  CHECK(folder.names() == std::vector<std::string>{"empty.pbrt"});
}

}  // namespace test_outputs
