// Parallel loops over oneTBB (its only user), and cooperative cancellation.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

namespace troffer {

// Runs body(i) for every i in [0, n), in any order, on `threads` threads (0 = all cores).
// Bodies must write to places that depend on i only, so that results do not depend on
// scheduling. The first exception is rethrown.
void parallel_for(size_t n, int threads, const std::function<void(size_t)>& body);

// As above with a small dense index in [0, thread_count(threads)) that no two concurrent bodies
// share: for per-thread scratch memory, never for results.
void parallel_for_slots(size_t n, int threads,
                        const std::function<void(size_t i, size_t slot)>& body);

// Runs body() such that TBB loops inside it, a library's own included, stay on this thread.
void run_on_one_thread(const std::function<void()>& body);

// `threads`, or the number of cores for 0.
int thread_count(int threads);

// Set from a signal handler or a progress callback; loops look at it between items of work.
using StopFlag = std::atomic<bool>;

}  // namespace troffer
