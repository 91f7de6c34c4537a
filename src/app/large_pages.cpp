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

// Limit on the heap that grows at the end of the data segment, bytes. Larger scenes get normal
// pages for the rest.
constexpr size_t most_reserved = size_t{1} << 30;
constexpr size_t share_of_memory = 4;  // divisor of the physical memory
// Larger blocks lie outside the heap and are returned when freed. Inside it, growing arrays would
// leave gaps of their size.
constexpr int largest_in_heap = 32 << 20;
// Up to this number, threads hardly wait for each other at one shared heap. More threads get heaps
// of their own, which have normal pages.
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

// Grows the heap by so many bytes and keeps it from shrinking. Returns false if that fails.
bool grow_heap(size_t bytes) {
  constexpr int usual_maps = 65536;
  if (mallopt(M_MMAP_THRESHOLD, largest_in_heap) == 0 || mallopt(M_MMAP_MAX, 0) == 0) return false;
  void* volatile const taken =
      mallopt(M_TRIM_THRESHOLD, INT32_MAX) != 0 ? std::malloc(bytes) : nullptr;
  std::free(taken);  // volatile keeps the compiler from removing the pair of calls
  mallopt(M_MMAP_MAX, usual_maps);
  return taken != nullptr;
}

// True if reserved memory counts as used memory.
bool is_reserving_dear() {
  std::ifstream file("/proc/sys/vm/overcommit_memory");
  int mode = 0;
  return !(file >> mode) || mode == 2;
}

}  // namespace

void use_large_pages() {
  const size_t page = size_t(std::max(sysconf(_SC_PAGESIZE), 4096L));
  const auto begin = reinterpret_cast<uintptr_t>(sbrk(0));
  // With base pages of 64 KiB, large pages are 512 MiB.
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
