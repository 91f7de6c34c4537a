// 64-bit hash of a sequence of numbers and texts. Solutions and checkpoints use it as a key: a
// change in the order or kind of the hashed values makes old files unreadable.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <type_traits>

#include "base/random.h"
#include "base/rgb.h"
#include "base/vec.h"

namespace troffer {

class Hasher {
 public:
  // Different values of `start` give unrelated hashes of the same sequence.
  explicit Hasher(uint64_t start) : hash_(start) {}

  // Integers and enumerators count as 64 bits, floating-point numbers as their bits.
  template <class T>
  void add(const T& v) {
    if constexpr (std::is_same_v<T, float>)
      add_word(std::bit_cast<uint32_t>(v));
    else if constexpr (std::is_same_v<T, double>)
      add_word(std::bit_cast<uint64_t>(v));
    else
      add_word(uint64_t(v));
  }
  void add(const Vec2& v) { add_all(v.x, v.y); }
  void add(const Vec3& v) { add_all(v.x, v.y, v.z); }
  void add(const Rgb& c) { add_all(c.r, c.g, c.b); }
  void add(const std::string& text) {
    add(text.size());
    for (const char c : text) add(static_cast<unsigned char>(c));
  }
  template <class... T>
  void add_all(const T&... v) {
    (add(v), ...);
  }

  uint64_t value() const { return hash_; }

 private:
  void add_word(uint64_t v) { hash_ = hash_combine(hash_, v); }

  uint64_t hash_;
};

}  // namespace troffer
