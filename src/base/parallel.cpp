#include "base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace troffer {

struct ThreadLimit::Limit {
  // Constructed in place, because a copied control ends with the original.
  explicit Limit(size_t threads) : control(tbb::global_control::max_allowed_parallelism, threads) {}
  tbb::global_control control;
};

ThreadLimit::ThreadLimit(int threads) {
  if (threads > 0) limit_ = std::make_unique<Limit>(size_t(threads));
}

ThreadLimit::~ThreadLimit() = default;

int thread_count(int threads) {
  if (threads > 0) return threads;
  const size_t allowed =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return std::min(tbb::info::default_concurrency(), int(std::min(allowed, size_t(1) << 20)));
}

void parallel_for_slots(size_t n, int threads, const std::function<void(size_t, size_t)>& body) {
  const int count = thread_count(threads);
  if (count == 1) {
    for (size_t i = 0; i < n; ++i) body(i, 0);
    return;
  }
  // An explicit thread count may exceed TBB's default for the machine.
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

void parallel_pieces(size_t n, size_t piece, const std::function<void(size_t, size_t)>& body) {
  if (n <= piece) {
    if (n > 0) body(0, n);
    return;
  }
  parallel_for((n + piece - 1) / piece, 0,
               [&](size_t i) { body(i * piece, std::min(n, (i + 1) * piece)); });
}

void parallel_for(size_t n, int threads, const std::function<void(size_t)>& body) {
  parallel_for_slots(n, threads, [&](size_t i, size_t) { body(i); });
}

}  // namespace troffer
