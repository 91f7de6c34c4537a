// Parallel loops over oneTBB (its only user), and cooperative cancellation.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>

namespace troffer {

// Runs body(i) for every i in [0, n), in any order, on `threads` threads (0 = all cores).
// Bodies must write to places that depend on i only, so that results do not depend on
// scheduling. The first exception is rethrown.
void parallel_for(size_t n, int threads, const std::function<void(size_t)>& body);

// As above with a small dense index in [0, thread_count(threads)) that no two concurrent bodies
// share: for per-thread scratch memory, never for results.
void parallel_for_slots(size_t n, int threads,
                        const std::function<void(size_t i, size_t slot)>& body);

// Runs body(first, end) for consecutive pieces of [0, n) of `piece` items (the last one of fewer),
// in any order, on all cores. Where the pieces are does not depend on threads.
void parallel_pieces(size_t n, size_t piece,
                     const std::function<void(size_t first, size_t end)>& body);

// Runs body() such that TBB loops inside it, a library's own included, stay on this thread.
void run_on_one_thread(const std::function<void()>& body);

// `threads`, or the number of cores for 0, as far as a ThreadLimit lets.
int thread_count(int threads);

// While it lives, 0 threads are `threads` (0: all cores) for whoever asks, libraries on oneTBB
// included: for work that is handed no number of its own.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Limit;
  std::unique_ptr<Limit> limit_;
};

// Set from a signal handler or a progress callback; loops look at it between items of work.
using StopFlag = std::atomic<bool>;

}  // namespace troffer
