// Pages of texels, and where on them each surface has its own.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/site_light.h"
#include "bake/surfaces.h"

namespace troffer {

struct AtlasOptions {
  double texels_per_metre = 0;  // 0: as many as fill one page of `resolution`
  int resolution = 512;         // texels along the side of that page
  int largest_page = 4096;      // texels along its side, a power of two or not
  int gutter = 2;               // texels around each chart that are its alone
};

struct Atlas {
  int size = 0, pages = 0;
  double texels_per_metre = 0;
  std::vector<int32_t> page;                       // per stand
  std::vector<std::vector<Vec2>> texel_of_vertex;  // per stand and vertex of its mesh: on the page
  size_t coarser = 0;                              // stands that would not fit a page, made coarser
};

// UsageError where more than max_texels would be needed.
Atlas make_atlas(const BakedSurfaces& surfaces, const AtlasOptions& options);

// The texels that surfaces cover, charts side by side, each in squares of 8 × 8.
class TexelSites final : public SiteList {
 public:
  TexelSites(const BakedSurfaces& surfaces, const Atlas& atlas);  // both must outlive this

  struct Texel {
    uint32_t stand = 0;
    uint32_t chart = 0;  // counted over all stands
    int32_t x = 0, y = 0;
    size_t first = 0;  // of `triangles`; the next texel's first is the end
  };
  size_t size() const override { return texels_.size(); }
  void pieces(size_t site, std::vector<Piece>& out) const override;
  const std::vector<Texel>& texels() const { return texels_; }
  // That lie in it.
  std::span<const uint32_t> triangles_of(size_t site) const {
    const size_t end = site + 1 < texels_.size() ? texels_[site + 1].first : triangles_.size();
    return {triangles_.data() + texels_[site].first, end - texels_[site].first};
  }

 private:
  const BakedSurfaces& surfaces_;
  const Atlas& atlas_;
  std::vector<Texel> texels_;
  std::vector<uint32_t> triangles_;  // that lie in a texel

  void add_chart(uint32_t stand, uint32_t number, const Chart& chart);
};

// A triangle of a stand as a piece: even, of no weight yet.
Piece piece_of(const MeshInWorld& mesh, uint32_t triangle);

}  // namespace troffer
