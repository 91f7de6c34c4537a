// Parallel loops on several threads, and their limit.
#include "base/parallel.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

using namespace troffer;

namespace {

// Number of threads that a loop with default thread count runs on.
size_t threads_of_loop() {
  std::mutex mutex;
  std::set<std::thread::id> seen;
  parallel_for(64, 0, [&](size_t) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const std::lock_guard lock(mutex);
    seen.insert(std::this_thread::get_id());
  });
  return seen.size();
}

}  // namespace

TEST_CASE("loops without a thread count respect an active limit") {
  const int all = thread_count(0);
  {
    const ThreadLimit limit(1);
    CHECK(thread_count(0) == 1);
    CHECK(threads_of_loop() == 1);
    CHECK(thread_count(3) == 3);
  }
  CHECK(thread_count(0) == all);
  const ThreadLimit none(0);
  CHECK(thread_count(0) == all);
  CHECK(threads_of_loop() >= size_t(std::min(all, 2)));
}

TEST_CASE("the pieces of a loop cover it exactly once") {
  for (const size_t n : {0, 1, 9, 10, 11, 95}) {
    std::vector<int> times(n, 0);
    std::mutex mutex;
    parallel_pieces(n, 10, [&](size_t first, size_t end) {
      const std::lock_guard lock(mutex);
      CHECK(first % 10 == 0);
      CHECK(end == std::min(n, first + 10));
      for (size_t i = first; i < end; ++i) ++times[i];
    });
    CHECK(times == std::vector<int>(n, 1));
  }
}
