// Rays and what they hit.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/vec.h"

namespace troffer {

// Points origin + t direction with t_min <= t <= t_max. The direction need not be unit.
struct Ray {
  Vec3 origin;
  float t_min = 0;
  Vec3 direction;
  float t_max = std::numeric_limits<float>::infinity();
};

// What lies between two points: t from 0 to 1.
inline Ray segment(const Vec3& from, const Vec3& to) {
  Ray r;
  r.origin = from;
  r.direction = to - from;
  r.t_max = 1;
  return r;
}

// What a ray stands for: a cone around it, as wide as this where the ray begins, wider by `spread`
// with every metre.
struct RayCone {
  float width = 0, spread = 0;
};

// Rays with t in [0, 1], as plain arrays: those that ask whether two points see each other. Only
// the first size() entries of the arrays count.
class Segments {
 public:
  static constexpr size_t coordinates = 6;  // of the origin, then of the direction

  size_t size() const { return size_; }
  const float* coordinate(size_t c) const { return arrays_[c].data(); }
  // Room for n more after the last, for the caller to write them to end(c)[0 … n - 1] …
  void make_room(size_t n) {
    if (arrays_[0].size() >= size_ + n) return;
    for (auto& a : arrays_) a.resize(2 * (size_ + n));
  }
  float* end(size_t c) { return arrays_[c].data() + size_; }
  // … of which the first n now count.
  void grow(size_t n) { size_ += n; }
  void clear() { size_ = 0; }

 private:
  std::array<std::vector<float>, coordinates> arrays_;
  size_t size_ = 0;
};

constexpr uint32_t no_geometry = 0xffffffffu;

// geometry: a mesh's index, or mesh count (all spheres), or mesh count + 1 (all disks), or mesh
// count + 2 + an instance's index (scene/mesh_in_world.h); primitive: the triangle, sphere or disk;
// u, v: barycentric weights of vertices 1 and 2.
struct Hit {
  float t = 0;
  float u = 0, v = 0;
  uint32_t geometry = no_geometry;
  uint32_t primitive = 0;
  bool is_valid() const { return geometry != no_geometry; }
};

}  // namespace troffer
