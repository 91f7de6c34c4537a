// Time limits, checkpoints and parts, as users call them.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "image/layered_image.h"
#include "image/read_image.h"
#include "program.h"

using namespace troffer;
using namespace troffer::test;

namespace test_lasting {

namespace {

using Words = std::vector<std::string>;

Words operator+(Words a, const Words& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

size_t black_pixels(const Image& image) {
  return size_t(std::count_if(image.pixels.begin(), image.pixels.end(),
                              [](const Rgb& p) { return p.is_black(); }));
}

// Expects one error line and no output.
void check_refused(const Finished& f, int status, const std::string& part) {
  CAPTURE(f.err);
  CHECK(f.status == status);
  REQUIRE(f.error_lines().size() == 1);
  CHECK(f.err.rfind("error: ", 0) == 0);
  CHECK(contains(f.err, part));
}

}  // namespace

TEST_CASE("a time limit ends a render with a complete picture, a message and exit status 0") {
  for (const std::string method : {"certified", "path"}) {
    const Folder folder;
    const std::string scene = folder.write("room.pbrt", bright_room_pbrt());
    const Finished f =
        run_program(folder, {"render", scene, "-o", folder.path("o.exr"), "--spp", "1000000",
                             "--method", method, "--time-limit", "1", "--stats",
                             folder.path("s.json"), "--aov", "error", "--quiet"});
    CAPTURE(f.err);
    CHECK(f.status == 0);
    CHECK(contains(f.err, "time limit: wrote the picture after"));
    CHECK(contains(read_file(folder.path("s.json")), "\"ended_by\": \"time_limit\""));
    const LayeredImage image = read_layers(folder.path("o.exr"));
    CHECK(black_pixels(image.layers[0].image) == 0);
    CHECK(black_pixels(image.layers[1].image) < 40 * 30 / 20);  // all pixels have an error
    CHECK(folder.names() == Words{"o.exr", "room.pbrt", "s.json"});
  }
}

TEST_CASE("a resumed run has the same bytes as an uninterrupted one") {
  for (const std::string method : {"path", "certified"})
    for (const int which : {SIGINT, SIGTERM}) {
      const Folder folder;
      const std::string scene = folder.write("room.pbrt", lit_floor_pbrt),
                        checkpoint = folder.path("c.chk");
      const Words render{"render", scene,   "--method", method,    "--spp",
                         "512",    "--aov", "error",    "--quiet", "-o"};
      REQUIRE(run_program(folder, render + Words{folder.path("whole.exr")}).status == 0);
      const Words kept = render + Words{folder.path("o.exr"), "--checkpoint", checkpoint,
                                        "--resume",           "--threads",    "1"};
      Running program(folder, kept);
      program.let_work(0.3);
      program.send(which);
      const int status = program.wait().status;
      CAPTURE(method);
      CHECK((status == 130 || status == 0));
      CHECK(std::filesystem::exists(checkpoint) == (status == 130));
      const Finished f = run_program(folder, kept);
      CAPTURE(f.err);
      CHECK(f.status == 0);
      CHECK(read_file(folder.path("o.exr")) == read_file(folder.path("whole.exr")));
      // A finished rendering removes its checkpoint.
      CHECK(folder.names() == Words{"o.exr", "room.pbrt", "whole.exr"});
    }
}

TEST_CASE("checkpoints that cannot be resumed, or would be overwritten, are refused") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt),
                    checkpoint = folder.path("c.chk");
  const Words kept{"render",       scene,      "-o",     folder.path("o.pfm"), "--method", "path",
                   "--checkpoint", checkpoint, "--quiet"};
  Running program(folder, kept + Words{"--spp", "1000000", "--threads", "1"});
  program.let_work(0.4);
  program.send(SIGINT);
  CHECK(program.wait().status == 130);
  const std::string bytes = read_file(checkpoint);
  REQUIRE(!bytes.empty());
  std::filesystem::remove(folder.path("o.pfm"));
  check_refused(run_program(folder, kept + Words{"--spp", "1000000"}), 1,
                "continue from it with --resume");
  check_refused(run_program(folder, kept + Words{"--resume", "--spp", "999999"}), 1,
                "other options");
  check_refused(
      run_program(folder, kept + Words{"--resume", "--spp", "1000000", "--sky", "overcast"}), 1,
      "another scene");
  check_refused(run_program(folder, {"render", scene, "-o", folder.path("o.pfm"), "--resume"}), 2,
                "--checkpoint");
  folder.write("c.chk", bytes.substr(0, bytes.size() / 2));
  check_refused(run_program(folder, kept + Words{"--resume", "--spp", "1000000"}), 1, "cut short");
  folder.write("c.chk", "mine");
  check_refused(run_program(folder, kept + Words{"--resume"}), 1, "not a checkpoint");
  CHECK(read_file(checkpoint) == "mine");
  check_refused(run_program(folder, {"render", scene, "-o", folder.path("o.pfm"), "--checkpoint",
                                     "/dev/null", "--resume"}),
                2, "regular file");
  check_refused(run_program(folder, {"render", scene, "-o", folder.path("o.pfm"), "--checkpoint",
                                     folder.path("no/c.chk")}),
                1, "cannot write");
  CHECK(folder.names() == Words{"c.chk", "room.pbrt"});
}

TEST_CASE("merged parts have the same bytes as a single run, in every format") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", bright_room_pbrt());
  for (const std::string method : {"certified", "fixed"})
    for (const bool has_crop : {false, true}) {
      Words render{"render",  scene, "--method", method, "--quiet", "--aov", "normal,error,depth",
                   "--error", ".1",  "--size",   "60x32"};
      if (has_crop) render = render + Words{"--crop", "7,3,51,30"};
      const Words formats{"exr", "hdr", "pfm", "png"};
      Words whole = render, parts;
      for (const std::string& f : formats) whole = whole + Words{"-o", folder.path("whole." + f)};
      REQUIRE(run_program(folder, whole).status == 0);
      for (const std::string k : {"3", "1", "2"}) {
        parts.push_back(folder.path("part" + k + ".exr"));
        REQUIRE(
            run_program(folder, render + Words{"--part", k + "/3", "-o", parts.back()}).status ==
            0);
      }
      for (const std::string& f : formats) {
        const std::string out = folder.path("merged." + f);
        const Finished merged = run_program(folder, Words{"merge", out} + parts);
        CAPTURE(merged.err);
        CHECK(merged.status == 0);
        CHECK(read_file(out) == read_file(folder.path("whole." + f)));
      }
    }
}

TEST_CASE("parts that do not make up a picture are refused, each with one line") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt), out = folder.path("out.exr");
  const auto part = [&](const std::string& name, const Words& options) {
    const Finished f = run_program(
        folder,
        Words{"render", scene, "--method", "fixed", "--quiet", "-o", folder.path(name)} + options);
    CAPTURE(f.err);
    CHECK(f.status == 0);
    return folder.path(name);
  };
  const std::string a = part("a.exr", {"--part", "1/2"}), b = part("b.exr", {"--part", "2/2"}),
                    of_three = part("c.exr", {"--part", "2/3"}),
                    other_seed = part("d.exr", {"--part", "2/2", "--seed", "1"}),
                    other_light = part("e.exr", {"--part", "2/2", "--sky", "overcast"}),
                    other_layers = part("f.exr", {"--part", "2/2", "--aov", "depth"}),
                    none = part("g.exr", {});
  const auto merge = [&](const Words& parts) {
    return run_program(folder, Words{"merge", out} + parts);
  };
  check_refused(merge({a}), 2, "missing");
  check_refused(merge({b}), 2, "missing");
  check_refused(merge({a, a}), 1, "part 1 of 2, as ");
  check_refused(merge({a, b, b}), 1, "part 2 of 2, as ");
  check_refused(merge({a, of_three}), 1, "one of 3 parts");
  check_refused(merge({a, other_seed}), 1, "other options");
  check_refused(merge({a, other_light}), 1, "another scene");
  check_refused(merge({a, other_layers}), 1, "other options");
  check_refused(merge({none, a}), 1, "not a part");
  check_refused(merge({a, scene}), 1, "room.pbrt");
  check_refused(merge({a, folder.path("missing.exr")}), 1, "cannot open");
  check_refused(run_program(folder, {"merge", folder.path("o.tga"), a, b}), 2, "format");
  CHECK(!std::filesystem::exists(out));
  CHECK(merge({b, a}).status == 0);
  CHECK(read_file(out) == read_file(none));

  // An interrupted part.
  std::filesystem::remove(b);
  Running program(folder, {"render", scene, "--method", "fixed", "--quiet", "-o", b, "--part",
                           "2/2", "--spp", "1000000", "--threads", "1"});
  program.let_work(0.3);
  program.send(SIGINT);
  CHECK(program.wait().status == 130);
  const std::string long_a =
      part("h.exr", {"--part", "1/2", "--spp", "1000000", "--time-limit", "0.3"});
  check_refused(merge({b, long_a}), 1, "unfinished");
  for (const std::string wrong : {"0/2", "3/2", "1", "1/", "/2", "1/2x", "-1/2", "1/0", "x"})
    check_refused(run_program(folder, {"render", scene, "-o", out, "--part", wrong}), 2, "--part");
  check_refused(run_program(folder, {"render", scene, "-o", out, "--part", "1/100"}), 2, "tiles");
  for (const Words& more : {Words{"--preview"}, {"--error-limit", ".1"}, {"-o", "o.png"}})
    check_refused(run_program(folder, Words{"render", scene, "-o", out, "--part", "1/2"} + more), 2,
                  "--part");
}

TEST_CASE("an error limit is reported, and a warning says if it is not reached") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", bright_room_pbrt());
  const auto render = [&](const Words& options) {
    return run_program(folder, Words{"render", scene, "-o", folder.path("o.exr"), "--method",
                                     "path", "--stats", folder.path("s.json")} +
                                   options);
  };
  CHECK(render({"--error-limit", ".1"}).remarks().empty());
  CHECK(contains(read_file(folder.path("s.json")), "\"ended_by\": \"error_limit\""));
  const Finished few = render({"--error-limit", ".01", "--spp", "4"});
  CHECK(few.status == 0);
  CHECK(contains(few.err, "above --error-limit"));
  CHECK(contains(read_file(folder.path("s.json")), "\"ended_by\": \"complete\""));
}

TEST_CASE("a disk too small for checkpoints causes a warning, and the picture is finished anyway") {
  const auto limit_files = [] {
    const rlimit limit{64 << 10, 64 << 10};
    setrlimit(RLIMIT_FSIZE, &limit);
  };
  for (const bool is_stopped : {false, true}) {
    const Folder folder;
    const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
    Running program(folder,
                    {"render", scene, "-o", folder.path("o.pfm"), "--method", "path", "--spp",
                     is_stopped ? "1000000" : "64", "--checkpoint", folder.path("c.chk"),
                     "--checkpoint-interval", ".01", "--quiet", "--threads", "1"},
                    limit_files);
    if (is_stopped) {
      program.let_work(0.4);
      program.send(SIGINT);
    }
    const Finished f = program.wait();
    CAPTURE(f.err);
    CHECK(f.status == (is_stopped ? 1 : 0));
    CHECK(f.error_lines().size() == (is_stopped ? 2 : 1));
    CHECK(f.err.rfind("warning: cannot write " + folder.path("c.chk") + ": File too large", 0) ==
          0);
    if (is_stopped)
      CHECK(contains(f.err, "\nerror: cannot write " + folder.path("c.chk") + ": File too large"));
    CHECK(read_image(folder.path("o.pfm")).width == 40);
    CHECK(folder.names() == Words{"o.pfm", "room.pbrt"});
  }
}

TEST_CASE("a folder that vanishes during the run, and one without write permission") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  std::filesystem::create_directory(folder.path("out"));
  Running program(folder, {"render", scene, "-o", folder.path("out/o.pfm"), "--method", "path",
                           "--spp", "1000000", "--quiet", "--threads", "1"});
  program.let_work(0.3);
  std::filesystem::remove_all(folder.path("out"));
  program.send(SIGINT);
  check_refused(program.wait(), 1, "cannot write " + folder.path("out/o.pfm"));
  CHECK(folder.names() == Words{"room.pbrt"});

  chmod(folder.path().c_str(), 0755);
  std::filesystem::create_directory(folder.path("locked"));
  chmod(folder.path("locked").c_str(), 0555);
  const auto as_anybody = [] {
    constexpr uid_t nobody = 65534;
    if (geteuid() == 0 && (setgid(nobody) != 0 || setuid(nobody) != 0)) _exit(126);
  };
  for (const std::string option : {"-o", "--checkpoint"}) {
    Words words{"render", scene, "--spp", "1000000"};
    words = words + (option == "-o"
                         ? Words{"-o", folder.path("locked/o.pfm")}
                         : Words{"-o", "/dev/stdout", "--checkpoint", folder.path("locked/c.chk")});
    if (option == "--checkpoint") {
      std::filesystem::create_symlink("/dev/null", folder.path("null.pfm"));
      words[5] = folder.path("null.pfm");
    }
    check_refused(Running(folder, words, as_anybody).wait(), 1,
                  "cannot write " + folder.path("locked/"));
  }
  CHECK(std::filesystem::is_empty(folder.path("locked")));
}

TEST_CASE("half-written files of killed programs are removed, files of others are not") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  const Words names{".troffer-7-0.tmp", ".troffer-8-0.tmp", ".troffer-9-0.tmp", "my.tmp"};
  for (const std::string& name : names) folder.write(name, "?");
  for (const std::string& name : {names[0], names[1], names[3]}) {
    const timespec old[2] = {{1000, 0}, {1000, 0}};
    utimensat(AT_FDCWD, folder.path(name).c_str(), old, 0);
  }
  const int held = open(folder.path(names[1]).c_str(), O_RDONLY);
  REQUIRE(flock(held, LOCK_EX) == 0);
  CHECK(run_program(folder, {"render", scene, "-o", folder.path("o.pfm"), "--method", "fixed",
                             "--checkpoint", folder.path("c.chk"), "--quiet"})
            .status == 0);
  CHECK(folder.names() == Words{names[1], names[2], names[3], "o.pfm", "room.pbrt"});
  close(held);
}

}  // namespace test_lasting
