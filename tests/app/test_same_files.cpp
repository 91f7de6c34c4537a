// An output may be neither an input nor another output, by any name, and links keep their targets.
// The program reports this before it computes or writes anything.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "image/image.h"
#include "image/write_image.h"
#include "program.h"

using namespace troffer;
using namespace troffer::test;

namespace test_same_files {

namespace {

using Words = std::vector<std::string>;
namespace fs = std::filesystem;

// A scene with an image and a mesh in files, and other inputs of commands.
class Inputs {
 public:
  Inputs() {
    write_image(folder.path("t.png"), Image(8, 8, Rgb{0.2f, 0.4f, 0.6f}));
    write_image(folder.path("sky.exr"), Image(8, 4, Rgb{1}));
    folder.write("part.pbrt",
                 "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"t.png\"\n"
                 "Material \"diffuse\" \"texture reflectance\" \"t\"\n"
                 "Shape \"sphere\" \"float radius\" 0.2\n");
    scene = folder.write("room.pbrt", std::string(lit_floor_pbrt) + "Include \"part.pbrt\"\n");
    points = folder.write("p.csv", "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n");
  }
  std::string path(const std::string& name) const { return folder.path(name); }

  // Expects that the command is refused with status 2 and one line, and that no file changes.
  void check_refused(const Words& words, const std::string& said) const {
    std::vector<std::string> before;
    for (const std::string& name : folder.names()) before.push_back(read_file(path(name)));
    const Words names = folder.names();
    const Finished f = run_program(folder, words);
    CAPTURE(f.err);
    CHECK(f.status == 2);
    CHECK(f.error_lines().size() == 1);
    CHECK(f.err.find(said) != std::string::npos);
    CHECK(folder.names() == names);
    for (size_t i = 0; i < names.size(); ++i) CHECK(read_file(path(names[i])) == before[i]);
  }

  Folder folder;
  std::string scene, points;
};

}  // namespace

TEST_CASE("an output that is an input is refused, by all commands and for all inputs") {
  const Inputs in;
  const std::string out = in.path("o.exr"), sky = in.path("sky.exr"), png = in.path("t.png");
  const Words render{"render", in.scene, "--spp", "100000"};
  const auto with = [](Words a, const Words& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  };
  in.check_refused(with(render, {"-o", out, "--stats", in.scene}), "is the same file as the scene");
  in.check_refused(with(render, {"-o", png}), "a file of the scene");
  in.check_refused(with(render, {"-o", png, "--preview"}), "a file of the scene");
  in.check_refused(with(render, {"-o", out, "--stats", in.path("part.pbrt")}),
                   "a file of the scene");
  in.check_refused(with(render, {"-o", sky, "--environment", sky + ",2"}), "--environment");
  in.check_refused(with(render, {"-o", out, "--checkpoint", in.scene, "--resume"}),
                   "is the same file as the scene");
  in.check_refused(with(render, {"-o", out, "--solution", in.points, "--stats", in.points}),
                   "is the same file as");
  const Words measure{"measure", in.scene, "--points", in.points};
  in.check_refused(with(measure, {"-o", in.scene}), "is the same file as the scene");
  in.check_refused(with(measure, {"-o", in.points}), "is the same file as --points");
  in.check_refused(with(measure, {"-o", png}), "a file of the scene");
  in.check_refused({"radiosity", in.scene, "-o", in.path("a.trad"), "--stats", in.scene},
                   "the scene");
  in.check_refused({"convert", in.scene, in.scene}, "the scene");
  in.check_refused({"convert", in.scene, in.path("part.pbrt")}, "a file of the scene");
  in.check_refused({"merge", sky, sky}, "the part");
  in.check_refused({"compare", png, png, "--map", png}, "the image");
  fs::create_directory(in.path("report"));
  fs::rename(in.scene, in.path("report/points.csv"));
  fs::create_symlink(in.path("report/points.csv"), in.scene);
  const Finished f =
      run_program(in.folder, {"report", in.scene, "-o", in.path("report"), "--pictures", "off"});
  CHECK(f.status == 2);
  CHECK(fs::file_size(in.path("report/points.csv")) > 100);
}

TEST_CASE("two outputs that are one file are refused, whatever they are called") {
  const Inputs in;
  const std::string a = in.path("a.exr"), other = in.path("./a.exr");
  const Words render{"render", in.scene, "--spp", "100000", "-o", a};
  const auto with = [&](const Words& b) {
    Words all = render;
    all.insert(all.end(), b.begin(), b.end());
    return all;
  };
  in.check_refused(with({"-o", a}), "each output needs a file of its own");
  in.check_refused(with({"-o", other}), "each output needs a file of its own");
  in.check_refused(with({"--stats", a}), "each output needs a file of its own");
  in.check_refused(with({"--stats", in.path("s"), "--checkpoint", in.path("s")}), "--checkpoint");
  // Neither exists yet; a link leads from one name to the other.
  fs::create_symlink("a.exr", in.path("link.exr"));
  in.check_refused(with({"-o", in.path("link.exr")}), "each output needs a file of its own");
  in.folder.write("a.exr", "mine");
  fs::create_hard_link(a, in.path("hard.exr"));
  in.check_refused(with({"-o", in.path("hard.exr")}), "each output needs a file of its own");
}

TEST_CASE("the files of standard output and standard error cannot be outputs or inputs") {
  const Inputs in;
  const auto run = [&](const Words& words, const std::string& name, int descriptor) {
    return Running(in.folder, words,
                   [&] { dup2(open(name.c_str(), O_WRONLY | O_APPEND), descriptor); })
        .wait();
  };
  const std::string before = read_file(in.points);
  const Words measure{"measure", in.scene, "--points", in.points, "--spp", "4"};
  CHECK(run(measure, in.points, STDOUT_FILENO).status == 2);
  CHECK(read_file(in.points) == before);
  const std::string log = in.folder.write("log", "");
  Words words = measure;
  words.insert(words.end(), {"-o", log});
  CHECK(run(words, log, STDERR_FILENO).status == 2);
}

TEST_CASE("devices and pipes may be named twice, and need no ending") {
  const Inputs in;
  const Words render{"render", in.scene, "--size", "8x6", "--spp", "1", "--method", "path"};
  const auto run = [&](const Words& more) {
    Words words = render;
    words.insert(words.end(), more.begin(), more.end());
    return run_program(in.folder, words);
  };
  CHECK(run({"-o", "/dev/null", "-o", "/dev/null", "--stats", "/dev/null"}).status == 0);
  const Finished piped = run({"-o", "/dev/stdout", "--quiet"});
  CHECK(piped.status == 0);
  CHECK(run({"-o", in.path("o.exr"), "--quiet"}).status == 0);
  CHECK(piped.out == read_file(in.path("o.exr")));
  CHECK(run({"-o", in.path("plain")}).status == 2);
  CHECK(run({"-o", in.folder.path()}).status == 2);
}

TEST_CASE("links are kept: dangling, chained and to other folders; loops are errors") {
  const Inputs in;
  fs::create_directory(in.path("deep"));
  fs::create_symlink("deep/new.exr", in.path("b.exr"));
  fs::create_symlink("b.exr", in.path("a.exr"));
  const auto render = [&](const std::string& out) {
    return run_program(in.folder, {"render", in.scene, "-o", out, "--size", "8x6", "--spp", "1",
                                   "--method", "path", "--quiet"});
  };
  for (int time = 0; time < 2; ++time) {
    CHECK(render(in.path("a.exr")).status == 0);
    CHECK(fs::is_symlink(in.path("a.exr")));
    CHECK(fs::is_symlink(in.path("b.exr")));
    CHECK(fs::is_regular_file(fs::symlink_status(in.path("deep/new.exr"))));
  }
  fs::create_symlink("loop2.exr", in.path("loop1.exr"));
  fs::create_symlink("loop1.exr", in.path("loop2.exr"));
  fs::create_symlink("nowhere/x.exr", in.path("lost.exr"));
  for (const char* name : {"loop1.exr", "lost.exr"}) {
    const Finished f = render(in.path(name));
    CAPTURE(f.err);
    CHECK(f.status == 1);
    CHECK(f.err.rfind("error: cannot write " + in.path(name), 0) == 0);
    CHECK(fs::is_symlink(in.path(name)));
  }
}

}  // namespace test_same_files
