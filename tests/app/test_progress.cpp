// The bar that tells how far a long command is: on a terminal, and nowhere else.
#include <doctest/doctest.h>
#include <pty.h>
#include <unistd.h>

#include <cstdio>
#include <string>
#include <thread>

#include "app/progress.h"

using namespace troffer;

namespace {

// Standard error goes to a terminal of our own while this lives.
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

  // What has been drawn, with an end mark so that there is always something to read.
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

TEST_CASE("progress tells what is done, how far it is, the memory and the time left") {
  const std::string text = drawn_at(.25, false);
  CAPTURE(text);
  CHECK(text.find("reading hall.obj [########........................]  25 %  ") !=
        std::string::npos);
  CHECK(text.find(" MB  ") != std::string::npos);
  CHECK(text.find("left") != std::string::npos);
  CHECK(text.ends_with("\r\033[K|"));  // and takes it away at the end
  CHECK(drawn_at(.25, true) == "|");
}
