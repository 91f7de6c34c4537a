// Parallel loops on oneTBB (its only user), and cooperative cancellation. Results never depend on
// the number of threads or on scheduling.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>

namespace troffer {

// Runs body(i) for every i in [0, n), in any order, on `threads` threads (0 = all cores). A body
// may only write to places that depend on i, so that results do not depend on scheduling. The first
// exception is rethrown.
void parallel_for(size_t n, int threads, const std::function<void(size_t)>& body);

// The same with a slot index in [0, thread_count(threads)) that no two concurrent bodies share. Use
// it for per-thread scratch memory, never for results.
void parallel_for_slots(size_t n, int threads,
                        const std::function<void(size_t i, size_t slot)>& body);

// Runs body(first, end) for consecutive pieces of `piece` items of [0, n), in any order, on all
// cores. The last piece may be shorter. The pieces do not depend on the number of threads.
void parallel_pieces(size_t n, size_t piece,
                     const std::function<void(size_t first, size_t end)>& body);

// Runs body() so that TBB loops inside it, a library's included, stay on this thread.
void run_on_one_thread(const std::function<void()>& body);

// Returns `threads`, or for 0 the number of cores that a ThreadLimit allows.
int thread_count(int threads);

// During its lifetime, 0 threads mean `threads` (0: all cores) for all callers and oneTBB
// libraries. For work that is not given a thread count.
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

// Set by a signal handler or a progress callback. Loops check it between items of work.
using StopFlag = std::atomic<bool>;

}  // namespace troffer
