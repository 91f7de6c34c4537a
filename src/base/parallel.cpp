#include "base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace troffer {

int thread_count(int threads) {
  return threads > 0 ? threads : tbb::info::default_concurrency();
}

void parallel_for_slots(size_t n, int threads, const std::function<void(size_t, size_t)>& body) {
  const int count = thread_count(threads);
  if (count == 1) {
    for (size_t i = 0; i < n; ++i) body(i, 0);
    return;
  }
  // An explicit request may exceed TBB's own idea of the machine.
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(count));
  tbb::task_arena arena(count);
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<size_t>(0, n, 1),
        [&](const tbb::blocked_range<size_t>& range) {
          const auto slot = size_t(tbb::this_task_arena::current_thread_index());
          for (size_t i = range.begin(); i != range.end(); ++i) body(i, slot);
        },
        tbb::simple_partitioner());
  });
}

void run_on_one_thread(const std::function<void()>& body) {
  tbb::task_arena arena(1);
  arena.execute(body);
}

void parallel_for(size_t n, int threads, const std::function<void(size_t)>& body) {
  parallel_for_slots(n, threads, [&](size_t i, size_t) { body(i); });
}

}  // namespace troffer
