// What lies about the vertices of meshes.
#pragma once

#include <vector>

#include "bake/site_light.h"
#include "bake/surfaces.h"

namespace troffer {

// Every vertex of every stand, in their order. Its value is the mean over the triangles that it is
// a corner of (of its chart, as charts share no vertices), by the weight that it has there.
class VertexSites final : public SiteList {
 public:
  explicit VertexSites(const BakedSurfaces& surfaces);  // must outlive this

  size_t size() const override { return first_of_stand_.back(); }
  void pieces(size_t site, std::vector<Piece>& out) const override;
  size_t first_of(size_t stand) const { return first_of_stand_[stand]; }

 private:
  struct Corners {
    std::vector<size_t> first;  // per vertex, of `triangles`; and the end
    std::vector<uint32_t> triangles;
  };
  const BakedSurfaces& surfaces_;
  std::vector<size_t> first_of_stand_;
  std::vector<Corners> corners_;  // per charted mesh
};

}  // namespace troffer
