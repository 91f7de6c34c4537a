// Lists the vertices of meshes as sites, for baking vertex colours.
#pragma once

#include <vector>

#include "bake/site_light.h"
#include "bake/surfaces.h"

namespace troffer {

// Every vertex of every stand, in order. Its value is the mean over the triangles around it,
// weighted by its barycentric weight. Charts share no vertices, so only triangles of its chart
// count.
class VertexSites final : public SiteList {
 public:
  explicit VertexSites(const BakedSurfaces& surfaces);  // must outlive this

  size_t size() const override { return first_of_stand_.back(); }
  void pieces(size_t site, std::vector<Piece>& out) const override;
  size_t first_of(size_t stand) const { return first_of_stand_[stand]; }

 private:
  struct Corners {
    std::vector<size_t> first;  // per vertex: start in `triangles`; the last entry is the end
    std::vector<uint32_t> triangles;
  };
  const BakedSurfaces& surfaces_;
  std::vector<size_t> first_of_stand_;
  std::vector<Corners> corners_;  // per charted mesh
};

}  // namespace troffer
