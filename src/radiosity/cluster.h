// Joins small adjacent triangles of one surface that are nearly coplanar. plan_joining() uses it to
// make sheets and elements of bounded number. Sizes are in metres.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/subdivide.h"

namespace troffer {

constexpr uint32_t no_cluster = 0xffffffffu;

// Up to two neighbours across each edge. If more triangles share an edge, each one knows only the
// previous and the next, so that flood fill stays linear on any mesh.
class Adjacency {
 public:
  explicit Adjacency(const BaseGeometry& geometry);
  // Six slots per triangle; no_cluster where empty.
  const uint32_t* neighbours(uint32_t triangle) const { return &neighbours_[6ull * triangle]; }

 private:
  std::vector<uint32_t> neighbours_;
};

struct JoinLimits {
  double size = 0;       // metres: diagonal of a cluster's box
  double cos_angle = 1;  // between a triangle's normal and that of the first triangle
  // join without adjacency: same surface, grid cell and nearest axis of the normal
  bool is_loose = false;
};

// Label per triangle, 0 to count - 1 in order of first triangles; no_cluster where `candidate` is
// 0. Joins only triangles of equal `group`.
struct Clusters {
  std::vector<uint32_t> label;
  uint32_t count = 0;
};
Clusters join_triangles(const BaseGeometry& geometry, const Adjacency& adjacency,
                        const std::vector<uint8_t>& candidate, const std::vector<uint32_t>& group,
                        const JoinLimits& limits);

}  // namespace troffer
