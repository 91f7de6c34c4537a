// Progress of long commands: a bar on a terminal, lines elsewhere.
#include <doctest/doctest.h>
#include <pty.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <thread>

#include "app/progress.h"

using namespace troffer;

namespace test_progress {

namespace {

// Redirects standard error to a pseudo-terminal for its lifetime.
class Terminal {
 public:
  Terminal() {
    REQUIRE(openpty(&master_, &slave_, nullptr, nullptr, nullptr) == 0);
    std::fflush(stderr);
    saved_ = dup(STDERR_FILENO);
    dup2(slave_, STDERR_FILENO);
  }
  ~Terminal() {
    dup2(saved_, STDERR_FILENO);
    for (const int file : {saved_, slave_, master_}) close(file);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  // Returns what has been drawn. An end mark ensures that there is something to read.
  std::string drawn() {
    REQUIRE(write(slave_, "|", 1) == 1);
    std::string all;
    while (!all.ends_with('|')) {
      char block[512];
      const ssize_t n = ::read(master_, block, sizeof block);
      REQUIRE(n > 0);
      all.append(block, size_t(n));
    }
    return all;
  }

 private:
  int master_ = -1, slave_ = -1, saved_ = -1;
};

std::string drawn_at(double fraction, bool is_quiet) {
  Terminal terminal;
  {
    ProgressBar bar("reading hall.obj", is_quiet);
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
    bar.update(fraction);
  }
  return terminal.drawn();
}

}  // namespace

TEST_CASE("progress shows the task, its share done, the memory and the time left") {
  const std::string text = drawn_at(.25, false);
  CAPTURE(text);
  CHECK(text.find("reading hall.obj [########........................]  25 %  ") !=
        std::string::npos);
  CHECK(text.find(" MB  ") != std::string::npos);
  CHECK(text.find("left") != std::string::npos);
  CHECK(text.ends_with("\r\033[K|"));  // the bar is erased at the end
  CHECK(drawn_at(.25, true) == "|");
}

TEST_CASE(
    "a progress bar fits its terminal: it shrinks, then drops time and memory, then all but the "
    "percentage") {
  const PhaseState state{.25, 30, 120};
  const auto drawn = [&](int columns) { return progress_bar("reading hall.obj", state, columns); };
  CHECK(drawn(120) ==
        "reading hall.obj [########........................]  25 %  120 MB  1:30 min left");
  for (int columns = 1; columns <= 200; ++columns) {
    CAPTURE(columns);
    CHECK(drawn(columns).size() < size_t(columns));
  }
  CHECK(drawn(60) == "reading hall.obj [##.........]  25 %  120 MB  1:30 min left");
  CHECK(drawn(50) == "reading hall.obj [##.......]  25 %  1:30 min left");
  CHECK(drawn(40) == "reading hall.obj [###...........]  25 %");
  CHECK(drawn(25) == "reading hall.obj  25 %");
  CHECK(drawn(12) == " 25 %");
  CHECK(drawn(3).empty());
  // Characters count, not bytes.
  CHECK(progress_bar("\xc3\xbc\xc3\xbc", {1, 1, 1}, 10) == "\xc3\xbc\xc3\xbc 100 %");
}

TEST_CASE("without a terminal each long phase prints a single line") {
  int ends[2] = {-1, -1};
  REQUIRE(pipe(ends) == 0);
  std::fflush(stderr);
  const int saved = dup(STDERR_FILENO);
  dup2(ends[1], STDERR_FILENO);
  {
    ProgressBar brief("reading", false), quiet("quiet", true), lasting("render", false);
    brief.update(.5);
    std::this_thread::sleep_for(std::chrono::milliseconds(2100));
    for (int i = 0; i < 100; ++i) {
      quiet.update(.5);
      lasting.update(.5);
    }
  }
  tell_done({"a.exr", "s.json"}, 2.1, .0123);
  dup2(saved, STDERR_FILENO);
  for (const int file : {saved, ends[1]}) close(file);
  char text[512];
  const ssize_t n = read(ends[0], text, sizeof text);
  close(ends[0]);
  REQUIRE(n > 0);
  const std::string all(text, size_t(n));
  CAPTURE(all);
  CHECK(all.rfind("render: 50 % after ", 0) == 0);
  CHECK(all.find(" s left\nwrote a.exr and s.json in 2.1 s, estimated error 1.2 %\n") !=
        std::string::npos);
  CHECK(std::count(all.begin(), all.end(), '\n') == 2);
}

}  // namespace test_progress
