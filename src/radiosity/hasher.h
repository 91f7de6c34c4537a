// A hash of what a solution depends on, number by number.
#pragma once

#include <bit>
#include <cstdint>

#include "base/random.h"
#include "scene/material.h"

namespace troffer {

class Hasher {
 public:
  void add(uint64_t v) { h_ = hash_combine(h_, v); }
  void add(float v) { add(uint64_t(std::bit_cast<uint32_t>(v))); }
  void add(const Vec3& v) {
    for (size_t i = 0; i < 3; ++i) add(v[i]);
  }
  void add(const Vec2& v) {
    add(v.x);
    add(v.y);
  }
  void add(Rgb c) {
    for (size_t i = 0; i < 3; ++i) add(c[i]);
  }
  void add(const ColorInput& c) {
    add(c.value);
    add(uint64_t(c.texture));
  }
  void add(const FloatInput& c) {
    add(c.value);
    add(uint64_t(c.texture));
    add(uint64_t(c.channel));
  }
  uint64_t value() const { return h_; }

 private:
  uint64_t h_ = 2;
};

}  // namespace troffer
