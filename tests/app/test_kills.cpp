// kill -9 at any moment: the last checkpoint and the old output stay intact, and the resumed run
// ends with the bytes of an uninterrupted one.
// TROFFER_KILLS=200 test_app --source-file='*/test_kills.cpp' kills 200 times; by default there are
// fewer.
#include <doctest/doctest.h>
#include <signal.h>

#include <cstdlib>
#include <filesystem>
#include <random>

#include "program.h"

using namespace troffer::test;

namespace test_kills {

namespace {

struct Killed {
  int kills = 0, kept = 0, finished = 0;
};

// Kills the program repeatedly, then lets it end.
void kill_again_and_again(const std::vector<std::string>& options, int kills, std::mt19937& random,
                          Killed& all) {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", bright_room_pbrt()),
                    out = folder.path("o.exr"), checkpoint = folder.path("c.chk");
  std::vector<std::string> words{"render", scene, "--quiet", "--aov", "normal,error"};
  words.insert(words.end(), options.begin(), options.end());
  std::vector<std::string> plain = words;
  plain.insert(plain.end(), {"-o", folder.path("whole.exr")});
  const Finished whole = run_program(folder, plain);
  REQUIRE(whole.status == 0);
  const std::string wanted = read_file(folder.path("whole.exr"));
  words.insert(words.end(), {"-o", out, "--checkpoint", checkpoint, "--resume",
                             "--checkpoint-interval", "0.005"});
  folder.write("o.exr", "mine");
  for (int done = 0; done < kills;) {
    Running program(folder, words);
    program.let_work(whole.processor_seconds * 1.1 * double(random()) / 4294967296.0);
    program.send(SIGKILL);
    const Finished f = program.wait();
    CAPTURE(f.err);
    const std::string now = read_file(out);
    CHECK((now == "mine" || now == wanted));
    all.kept += std::filesystem::exists(checkpoint) ? 1 : 0;
    if (f.status == 128 + SIGKILL) {
      ++done;
      ++all.kills;
      continue;
    }
    // It had ended before the kill, with a valid checkpoint and the right result.
    CHECK(f.status == 0);
    CHECK(now == wanted);
    ++all.finished;
    folder.write("o.exr", "mine");
  }
  const Finished last = run_program(folder, words);
  CAPTURE(last.err);
  CHECK(last.status == 0);
  CHECK(read_file(out) == wanted);
  CHECK(!std::filesystem::exists(checkpoint));
}

}  // namespace

TEST_CASE("kill -9 at random moments leaves checkpoint and output intact, by every method") {
  const char* asked = std::getenv("TROFFER_KILLS");
  const int kills = asked != nullptr ? std::atoi(asked) : 12;
  REQUIRE(kills >= 4);
  std::mt19937 random(1);
  Killed all;
  const std::vector<std::vector<std::string>> methods{
      {"--method", "path", "--spp", "64"},
      {"--error", ".1"},
      {"--method", "fixed", "--spp", "32"},
      {"--method", "kj92", "--variance", ".1", "--max-spp", "16"}};
  for (size_t m = 0; m < methods.size(); ++m) {
    CAPTURE(methods[m][1]);
    const int share =
        kills * int(m + 1) / int(methods.size()) - kills * int(m) / int(methods.size());
    kill_again_and_again(methods[m], share, random, all);
  }
  CHECK(all.kills == kills);
  CHECK(all.kept > 0);
  MESSAGE(all.kills << " kills; after " << all.kept << " a checkpoint was there, " << all.finished
                    << " runs ended before theirs");
}

}  // namespace test_kills
