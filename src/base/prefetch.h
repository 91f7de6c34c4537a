// Hints to fetch what is needed soon: no effect but on time.
#pragma once

#include <cstddef>

namespace troffer {

// All of an object, line by line.
template <class T>
inline void prefetch_object(const T& object) {
#if defined(__GNUC__) || defined(__clang__)
  constexpr size_t line = 64;  // bytes
  const auto* at = reinterpret_cast<const char*>(&object);
  for (size_t i = 0; i < sizeof(T); i += line) __builtin_prefetch(at + i);
#else
  static_cast<void>(object);
#endif
}

}  // namespace troffer
