// Joining of small triangles: adjacent ones of the same surface that are nearly coplanar.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/subdivide.h"

namespace troffer {

constexpr uint32_t no_cluster = 0xffffffffu;

// Up to two neighbours at each edge. Where more than two triangles share an edge each knows the
// next ones only, so that flooding stays linear on any mesh.
class Adjacency {
 public:
  explicit Adjacency(const BaseGeometry& geometry);
  // Six slots per triangle, no_cluster where empty.
  const uint32_t* neighbours(uint32_t triangle) const { return &neighbours_[6ull * triangle]; }

 private:
  std::vector<uint32_t> neighbours_;
};

struct JoinLimits {
  double size = 0;        // metres: diagonal of a cluster's box
  double cos_angle = 1;   // of a triangle's normal to the first one's
  bool is_loose = false;  // do not ask for adjacency: same surface, same grid cell of `size`, same
                          // nearest axis of the normal
};

// Label per triangle, 0 … count - 1 in order of first triangles; no_cluster where `candidate` is 0.
// Only triangles of equal `group` are joined.
struct Clusters {
  std::vector<uint32_t> label;
  uint32_t count = 0;
};
Clusters join_triangles(const BaseGeometry& geometry, const Adjacency& adjacency,
                        const std::vector<uint8_t>& candidate, const std::vector<uint32_t>& group,
                        const JoinLimits& limits);

}  // namespace troffer
