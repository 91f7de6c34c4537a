#include "app/large_pages.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <thread>

#if defined(__linux__) && defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)
#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>
#endif

namespace troffer {

#if defined(MADV_HUGEPAGE)

namespace {

// Bytes, of the heap that grows at the end of the program's data: scenes that need more get usual
// pages for the rest.
constexpr size_t most_reserved = size_t{1} << 30;
constexpr size_t share_of_memory = 4;  // one of so many parts
// Larger ones lie outside the heap, and are given back when they are freed: in it, arrays that grow
// to such a size would leave gaps as large.
constexpr int largest_in_heap = 32 << 20;
// So few threads hardly wait for each other where all take from one heap. Heaps of their own, which
// more of them get, have usual pages.
constexpr unsigned most_threads_of_heap = 4;

size_t bytes_to_reserve(size_t page) {
  const long pages = sysconf(_SC_PHYS_PAGES);
  if (pages <= 0) return 0;
  size_t memory = size_t(pages) * page;
  for (const auto which : {RLIMIT_AS, RLIMIT_DATA}) {
    rlimit limit{};
    if (getrlimit(which, &limit) != 0) return 0;
    if (limit.rlim_cur != RLIM_INFINITY) memory = std::min(memory, size_t(limit.rlim_cur));
  }
  return std::min(memory / share_of_memory, most_reserved);
}

// Has the heap grow by so much, and not shrink.
bool grow_heap(size_t bytes) {
  constexpr int usual_maps = 65536;
  if (mallopt(M_MMAP_THRESHOLD, largest_in_heap) == 0 || mallopt(M_MMAP_MAX, 0) == 0) return false;
  void* volatile const taken =
      mallopt(M_TRIM_THRESHOLD, INT32_MAX) != 0 ? std::malloc(bytes) : nullptr;
  std::free(taken);  // volatile: or the pair of calls is left out
  mallopt(M_MMAP_MAX, usual_maps);
  return taken != nullptr;
}

// Then what is reserved counts as if it were used.
bool is_reserving_dear() {
  std::ifstream file("/proc/sys/vm/overcommit_memory");
  int mode = 0;
  return !(file >> mode) || mode == 2;
}

}  // namespace

void use_large_pages() {
  const size_t page = size_t(std::max(sysconf(_SC_PAGESIZE), 4096L));
  const auto begin = reinterpret_cast<uintptr_t>(sbrk(0));
  // With pages of 64 KiB large ones have 512 MiB.
  if (page != 4096 || is_reserving_dear()) return;
  if (!grow_heap(bytes_to_reserve(page))) return;
  if (std::thread::hardware_concurrency() <= most_threads_of_heap) mallopt(M_ARENA_MAX, 1);
  const uintptr_t first = (begin + page - 1) / page * page;
  const auto end = reinterpret_cast<uintptr_t>(sbrk(0));
  if (end > first) madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
}

#else

void use_large_pages() {}

#endif

}  // namespace troffer
