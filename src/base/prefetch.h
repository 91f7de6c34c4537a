// Hints to load memory into the cache. Loops over many lookups issue them ahead of use. They affect
// only speed, and compile to nothing where the compiler has no such hint.
#pragma once

#include <cstddef>

namespace troffer {

// Prefetches the cache line of an address.
inline void prefetch_line([[maybe_unused]] const void* at) {
#if defined(__GNUC__) || defined(__clang__)
  __builtin_prefetch(at);
#endif
}

// Prefetches all cache lines of an object.
template <class T>
void prefetch_object(const T& object) {
  constexpr size_t line = 64;  // bytes
  const auto* at = reinterpret_cast<const char*>(&object);
  for (size_t i = 0; i < sizeof(T); i += line) prefetch_line(at + i);
}

}  // namespace troffer
