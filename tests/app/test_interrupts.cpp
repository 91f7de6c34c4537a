// Signals, and programs that run at the same time.
#include <doctest/doctest.h>
#include <signal.h>

#include <memory>

#include "image/read_image.h"
#include "program.h"

using namespace troffer;
using namespace troffer::test;

namespace test_interrupts {

TEST_CASE("SIGINT and SIGTERM stop a long render, which writes its unfinished picture") {
  for (const int which : {SIGINT, SIGTERM})
    for (const std::string method : {"certified", "path", "fixed"}) {
      const Folder folder;
      const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
      Running program(folder,
                      {"render", scene, "-o", folder.path("o.exr"), "--spp", "1000000", "--method",
                       method, "--stats", folder.path("s.json"), "--threads", "1"});
      program.let_work(0.5);
      program.send(which);
      const Finished f = program.wait();
      CAPTURE(which);
      CAPTURE(method);
      CHECK(f.status == 130);
      CHECK(f.seconds_after_signal < 5);
      CHECK(folder.names() == std::vector<std::string>{"o.exr", "room.pbrt", "s.json"});
      const Image image = read_image(folder.path("o.exr"));
      CHECK(image.width == 40);
      CHECK(read_file(folder.path("s.json")).find("\"is_complete\": false") != std::string::npos);
    }
}

TEST_CASE("a signal stops measuring, even within one point") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  const std::string points = folder.write("p.csv", "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n1,0,0,0,0,1\n");
  Running program(folder, {"measure", scene, "--points", points, "-o", folder.path("o.csv"),
                           "--spp", "50000000", "--threads", "1"});
  program.let_work(0.5);
  program.send(SIGINT);
  const Finished f = program.wait();
  CHECK(f.status == 130);
  CHECK(f.seconds_after_signal < 5);
  // No point has a value.
  CHECK(f.err == "interrupted after 0 of 2 points: nothing was written\n");
  CHECK(folder.names() == std::vector<std::string>{"p.csv", "room.pbrt"});
}

TEST_CASE("a render with many sources and shadow rays stops within seconds") {
  const Folder folder;
  std::string text = lit_floor_pbrt;
  for (int i = 0; i < 2000; ++i)
    text += "AttributeBegin\nTranslate " + std::to_string(0.04 * (i % 50) - 1) + " " +
            std::to_string(0.04 * (i / 50) - 0.8) +
            " 1.5\nAreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n"
            "Shape \"sphere\" \"float radius\" [0.01]\nAttributeEnd\n";
  const std::string scene = folder.write("many.pbrt", text);
  Running program(folder, {"render", scene, "-o", folder.path("o.exr"), "--spp", "16", "--method",
                           "fixed", "--shadow-rays", "64", "--threads", "1"});
  program.let_work(0.8);
  program.send(SIGINT);
  const Finished f = program.wait();
  CHECK(f.status == 130);
  CHECK(f.seconds_after_signal < 5);
}

TEST_CASE("concurrent programs that write the same file do not clash") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt), out = folder.path("o.exr");
  std::vector<std::unique_ptr<Running>> programs;
  for (int i = 0; i < 4; ++i)
    programs.push_back(std::make_unique<Running>(
        folder, std::vector<std::string>{"render", scene, "-o", out, "--threads", "1", "--quiet"}));
  for (const auto& p : programs) {
    const Finished f = p->wait();
    CHECK(f.status == 0);
    CHECK(f.remarks().empty());
  }
  CHECK(folder.names() == std::vector<std::string>{"o.exr", "room.pbrt"});
  CHECK(read_image(out).width == 40);
}

TEST_CASE("an existing output is only replaced by a complete one") {
  const Folder folder;
  const std::string good = folder.write("good.pbrt", lit_floor_pbrt);
  const std::string bad = folder.write("bad.pbrt", "WorldBegin\nShape");
  const std::string out = folder.write("o.pfm", "mine");
  CHECK(run_program(folder, {"render", bad, "-o", out}).status == 1);
  CHECK(read_file(out) == "mine");
  CHECK(run_program(folder, {"render", good, "-o", out}).status == 0);
  CHECK(read_image(out).width == 40);
}

}  // namespace test_interrupts
