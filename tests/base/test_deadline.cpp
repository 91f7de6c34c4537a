// Deadlines set their flag in time and tell a timeout from a stop.
#include "base/deadline.h"

#include <doctest/doctest.h>

using namespace troffer;

namespace {

constexpr std::chrono::hours far_off{1000};

// Waits without limit.
void wait_for(const StopFlag& flag) {
  while (!flag.load()) std::this_thread::yield();
}

}  // namespace

TEST_CASE("a deadline sets its flag when time is up and reports it") {
  const StopFlag parent = false;
  const Deadline past(parent, Deadline::Clock::now());
  wait_for(past.flag());
  CHECK(past.is_over());
  CHECK(past.seconds_left() < 0);
  const Deadline future(parent, Deadline::Clock::now() + far_off);
  CHECK(!future.flag().load());
  CHECK(!future.is_over());
  CHECK(future.seconds_left() > 3000);
}

TEST_CASE("a deadline ends early by its reserve; a stop by the parent does not count as time up") {
  StopFlag parent = false;
  Deadline kept(parent, Deadline::Clock::now() + far_off),
      stopped(parent, Deadline::Clock::now() + far_off);
  kept.keep_back(1e9);
  wait_for(kept.flag());
  CHECK(kept.is_over());
  CHECK(!stopped.flag().load());
  parent = true;
  wait_for(stopped.flag());
  CHECK(!stopped.is_over());
  CHECK(!kept.is_over());  // a stop by the parent is no timeout
}
