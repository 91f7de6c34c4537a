#include "base/process_group.h"

#include <atomic>

namespace troffer {

bool share(ProcessGroup* group, const SharedWork& work, const StopFlag& stop) {
  if (group != nullptr) return group->share(work, stop);
  const size_t count = work.has_order ? work.order.size() : work.items;
  std::atomic<bool> is_broken_off = false;
  parallel_for_slots(count, work.threads, [&](size_t i, size_t slot) {
    if (stop.load(std::memory_order_relaxed)) is_broken_off = true;
    if (is_broken_off.load(std::memory_order_relaxed)) return;
    if (!work.act(work.has_order ? work.order[i] : i, slot)) is_broken_off = true;
  });
  return !is_broken_off;
}

}  // namespace troffer
