// Arranges the charts of all surfaces on pages of texels, and lists the texels that surfaces cover.
// bake() lights these texels (site_light.h) and writes the pages as lightmaps.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/site_light.h"
#include "bake/surfaces.h"

namespace troffer {

// Density and page size of an atlas.
struct AtlasOptions {
  double texels_per_metre = 0;  // 0: as many as fit one page of `resolution`
  int resolution = 512;         // side of that page, texels
  int largest_page = 4096;      // side of a page, texels; need not be a power of two
  int gutter = 2;  // width of the zone around each chart that no other chart uses, texels
};

// Pages, and the place of every vertex on them.
struct Atlas {
  int size = 0, pages = 0;
  double texels_per_metre = 0;
  std::vector<int32_t> page;                       // page of each stand
  std::vector<std::vector<Vec2>> texel_of_vertex;  // by stand and vertex of its mesh: position on
                                                   // the page, texels
  size_t coarser = 0;  // number of stands with reduced density, because they would not fit a page
};

// Throws UsageError if more than 64 pages or 134 million texels would be needed.
Atlas make_atlas(const BakedSurfaces& surfaces, const AtlasOptions& options);

// The texels that surfaces cover, chart by chart, in blocks of 8 × 8 texels.
class TexelSites final : public SiteList {
 public:
  TexelSites(const BakedSurfaces& surfaces, const Atlas& atlas);  // both must outlive this

  struct Texel {
    uint32_t stand = 0;
    uint32_t chart = 0;  // chart number, counted over all stands
    int32_t x = 0, y = 0;
    size_t first = 0;  // start in triangles_; the next texel's `first` is the end
  };
  size_t size() const override { return texels_.size(); }
  void pieces(size_t site, std::vector<Piece>& out) const override;
  const std::vector<Texel>& texels() const { return texels_; }
  // Triangles that overlap the texel of a site.
  std::span<const uint32_t> triangles_of(size_t site) const {
    const size_t end = site + 1 < texels_.size() ? texels_[site + 1].first : triangles_.size();
    return {triangles_.data() + texels_[site].first, end - texels_[site].first};
  }

 private:
  const BakedSurfaces& surfaces_;
  const Atlas& atlas_;
  std::vector<Texel> texels_;
  std::vector<uint32_t> triangles_;  // triangles of all texels, one texel after the other

  void add_chart(uint32_t stand, uint32_t number, const Chart& chart);
};

// Returns a triangle of a stand as a piece, sampled uniformly, with weight 0.
Piece piece_of(const MeshInWorld& mesh, uint32_t triangle);

}  // namespace troffer
