// Rays, segments and hits: input and output of Tracer. Distances are multiples of the direction.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/vec.h"

namespace troffer {

// The points origin + t direction with t_min <= t <= t_max. The direction need not be unit.
struct Ray {
  Vec3 origin;
  float t_min = 0;
  Vec3 direction;
  float t_max = std::numeric_limits<float>::infinity();
};

// Returns the ray from one point to another, with t from 0 to 1.
inline Ray segment(const Vec3& from, const Vec3& to) {
  Ray r;
  r.origin = from;
  r.direction = to - from;
  r.t_max = 1;
  return r;
}

// Cone around a ray: its width at the origin in metres, and the growth of the width per metre.
struct RayCone {
  float width = 0, spread = 0;
};

// Segments (t from 0 to 1) in separate arrays, for shadow rays. Only the first size() entries
// count.
class Segments {
 public:
  static constexpr size_t coordinates = 6;  // those of the origin, then those of the direction

  size_t size() const { return size_; }
  const float* coordinate(size_t c) const { return arrays_[c].data(); }
  // Makes room for n more segments, which the caller writes to end(c)[0] … end(c)[n - 1].
  void make_room(size_t n) {
    if (arrays_[0].size() >= size_ + n) return;
    for (auto& a : arrays_) a.resize(2 * (size_ + n));
  }
  float* end(size_t c) { return arrays_[c].data() + size_; }
  // Adds the first n segments written to end(c).
  void grow(size_t n) { size_ += n; }
  void clear() { size_ = 0; }

 private:
  std::array<std::vector<float>, coordinates> arrays_;
  size_t size_ = 0;
};

constexpr uint32_t no_geometry = 0xffffffffu;

// The closest hit of a ray. geometry: a mesh's index; mesh count for all spheres; mesh count + 1
// for all disks; mesh count + 2 + an instance's index (scene/mesh_in_world.h). primitive: index of
// the triangle, sphere or disk. u, v: barycentric weights of vertices 1 and 2. t: in units of the
// ray's direction.
struct Hit {
  float t = 0;
  float u = 0, v = 0;
  uint32_t geometry = no_geometry;
  uint32_t primitive = 0;
  bool is_valid() const { return geometry != no_geometry; }
};

}  // namespace troffer
