// `render` and `measure` with --solution and cells: a file keeps the cells, and later runs extend
// it.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "image/read_image.h"
#include "program.h"

using namespace troffer;
using namespace troffer::test;

namespace test_solution_command {

namespace {

std::vector<std::string> render_of(const Folder& folder, const std::string& scene,
                                   std::vector<std::string> more) {
  more.insert(more.begin(), {"render", scene, "-o", folder.path("o.exr"), "--error", ".05",
                             "--size", "40x30", "--solution", folder.path("a.cells")});
  return more;
}

double mean(const std::string& file) {
  const Image image = read_image(file);
  double sum = 0;
  for (const Rgb& p : image.pixels) sum += double(p.g);
  return sum / double(image.pixels.size());
}

double rounds_told(const Folder& folder) {
  const std::string json = troffer::test::read_file(folder.path("s.json"));
  const size_t at = json.find("\"rounds\":");
  REQUIRE(at != std::string::npos);
  return std::stod(json.substr(at + 9));
}

}  // namespace

TEST_CASE("--solution stores cells; the next view reuses them with the same result") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", bright_room_pbrt());
  const std::string stats = folder.path("s.json"), file = folder.path("a.cells");
  const Finished first = run_program(folder, render_of(folder, scene, {"--stats", stats}));
  CAPTURE(first.err);
  REQUIRE(first.status == 0);
  CHECK(first.err.find("kept ") != std::string::npos);
  const double rounds = rounds_told(folder), m = mean(folder.path("o.exr"));
  const std::string kept = troffer::test::read_file(file);
  REQUIRE(
      run_program(folder, render_of(folder, scene, {"--stats", stats, "--threads", "1"})).status ==
      0);
  CHECK(rounds_told(folder) < rounds);
  CHECK(mean(folder.path("o.exr")) == doctest::Approx(m).epsilon(2e-3));
  // Another view, for which the file has no cells yet: the same result as without the file.
  const std::vector<std::string> elsewhere{
      "--quiet", "--eye", "1.4,-1.2,1.1", "--target", "0,1,0.4", "--threads", "2"};
  REQUIRE(run_program(folder, render_of(folder, scene, elsewhere)).status == 0);
  const double by_kept = mean(folder.path("o.exr"));
  CHECK(troffer::test::read_file(file).size() > kept.size());
  REQUIRE(std::filesystem::remove(file));
  REQUIRE(run_program(folder, render_of(folder, scene, elsewhere)).status == 0);
  CHECK(mean(folder.path("o.exr")) == doctest::Approx(by_kept).epsilon(5e-3));
}

TEST_CASE("--solution: same cells and picture for any number of threads") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", bright_room_pbrt());
  std::vector<std::string> files, pictures;
  for (const char* threads : {"1", "2"}) {
    std::filesystem::remove(folder.path("a.cells"));
    for (int view = 0; view < 2; ++view)
      REQUIRE(run_program(folder, render_of(folder, scene,
                                            {"--quiet", "--threads", threads, "--eye",
                                             view == 0 ? "1.4,-1.2,1.1" : "-1.3,-1,1.5", "--target",
                                             "0,1,0.4"}))
                  .status == 0);
    files.push_back(troffer::test::read_file(folder.path("a.cells")));
    pictures.push_back(troffer::test::read_file(folder.path("o.exr")));
  }
  CHECK(files[0] == files[1]);
  CHECK(pictures[0] == pictures[1]);
}

TEST_CASE("--solution: measure reads and stores cells too") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", bright_room_pbrt());
  const std::string points = folder.write("p.csv", "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n1,0,0,0,0,1\n");
  const std::string file = folder.path("a.cells");
  const std::vector<std::string> plain{"measure", scene, "--points", points, "--quiet"};
  std::vector<std::string> keeping = plain;
  keeping.insert(keeping.end(), {"--solution", file});
  std::vector<std::string> by_cells = plain;  // by default two points are measured by paths
  by_cells.insert(by_cells.end(), {"--indirect", "cells"});
  const std::vector<Measured> without = measured(run_program(folder, by_cells));
  const std::vector<Measured> first = measured(run_program(folder, keeping));
  const std::vector<Measured> second = measured(run_program(folder, keeping));
  REQUIRE(without.size() == 2);
  REQUIRE(first.size() == 2);
  REQUIRE(second.size() == 2);
  for (size_t i = 0; i < 2; ++i) {
    CHECK(first[i].lx == without[i].lx);
    CHECK(second[i].lx == doctest::Approx(first[i].lx).epsilon(5e-3));
  }
}

TEST_CASE("--solution: stored cells, and views and points that see nothing") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", bright_room_pbrt());
  const std::string points = folder.write("p.csv", "x,y,z,nx,ny,nz\n500,500,500,0,0,1\n");
  REQUIRE(run_program(folder, render_of(folder, scene, {"--quiet"})).status == 0);
  const Finished view = run_program(
      folder,
      render_of(folder, scene, {"--quiet", "--eye", "500,500,500", "--target", "900,900,900"}));
  CHECK(view.status == 0);
  CHECK(mean(folder.path("o.exr")) == 0);
  const std::vector<Measured> m = measured(run_program(
      folder, {"measure", scene, "--points", points, "--solution", folder.path("a.cells")}));
  REQUIRE(m.size() == 1);
  CHECK(m[0].lx == 0);
}

TEST_CASE("--solution: cells of another scene, damaged ones and other files are refused") {
  const Folder folder;
  std::string text = lit_floor_pbrt;
  text.replace(text.find("[5 5 5]"), 7, "[5 5 4]");
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt),
                    other = folder.write("other.pbrt", text), file = folder.path("a.cells");
  REQUIRE(run_program(folder, render_of(folder, other, {"--quiet"})).status == 0);
  std::filesystem::remove(folder.path("o.exr"));
  const std::string whole = troffer::test::read_file(file);
  for (const std::string& bytes : {whole, whole.substr(0, whole.size() / 2), std::string("abc")}) {
    folder.write("a.cells", bytes);
    const Finished f = run_program(
        folder, render_of(folder, bytes == whole ? scene : other, {"--indirect", "cells"}));
    CAPTURE(f.err);
    CHECK(f.status == 1);
    CHECK(f.error_lines().size() == 1);
    CHECK(f.err.rfind("error: ", 0) == 0);
    CHECK(troffer::test::read_file(file) == bytes);
  }
  for (const std::string& n : folder.names()) CHECK(n != "o.exr");
  // kj92 needs a radiosity solution.
  folder.write("a.cells", whole);
  CHECK(run_program(folder, render_of(folder, other, {"--method", "kj92"})).status == 1);
}

TEST_CASE("radiosity --cells computes cells of all surfaces for any view, also under a sky") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", bright_room_pbrt()),
                    file = folder.path("a.cells"), stats = folder.path("s.json");
  const std::vector<std::string> sky{"--sky", "overcast"};
  std::vector<std::string> make{"radiosity", scene, "--cells", "-o", file, "--quiet"};
  make.insert(make.end(), sky.begin(), sky.end());
  REQUIRE(run_program(folder, make).status == 0);
  for (const char* eye : {"1.4,-1.2,1.1", "-1.3,-1,1.5"}) {
    std::vector<std::string> view{"--quiet", "--eye", eye, "--target", "0,1,0.4", "--stats", stats};
    view.insert(view.end(), sky.begin(), sky.end());
    REQUIRE(run_program(folder, render_of(folder, scene, view)).status == 0);
    const double by_kept = mean(folder.path("o.exr")), rounds = rounds_told(folder);
    const std::vector<std::string> words = render_of(folder, scene, view);
    std::vector<std::string> alone(words.begin(), words.end());
    alone.erase(std::find(alone.begin(), alone.end(), "--solution"),
                std::find(alone.begin(), alone.end(), "--solution") + 2);
    alone.insert(alone.end(), {"--indirect", "cells"});
    REQUIRE(run_program(folder, alone).status == 0);
    CHECK(mean(folder.path("o.exr")) == doctest::Approx(by_kept).epsilon(5e-3));
    CHECK(rounds < rounds_told(folder));
  }
  // Refused under another sky, and not available as a viewable file.
  CHECK(run_program(folder, render_of(folder, scene, {"--quiet"})).status == 1);
  CHECK(run_program(folder, {"radiosity", scene, "--cells", "-o", folder.path("a.gltf")}).status ==
        2);
}

}  // namespace test_solution_command
