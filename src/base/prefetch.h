// Hints to fetch what is needed soon: no effect but on time.
#pragma once

#include <cstddef>

namespace troffer {

// The line of memory that this is in.
inline void prefetch_line([[maybe_unused]] const void* at) {
#if defined(__GNUC__) || defined(__clang__)
  __builtin_prefetch(at);
#endif
}

// All of an object, line by line.
template <class T>
void prefetch_object(const T& object) {
  constexpr size_t line = 64;  // bytes
  const auto* at = reinterpret_cast<const char*>(&object);
  for (size_t i = 0; i < sizeof(T); i += line) prefetch_line(at + i);
}

}  // namespace troffer
