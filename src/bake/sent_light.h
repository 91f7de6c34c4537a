// Base colour and coverage of surfaces at texels, for pictures that replace lights (unlit,
// emissive).
#pragma once

#include <vector>

#include "bake/atlas.h"
#include "bake/page.h"

namespace troffer {

// Averages over each texel. scene: the prepared scene, whose textures have mip levels.
class SentLight {
 public:
  explicit SentLight(const Scene& scene) : scene_(scene) {}  // must outlive this

  // Returns color: base colour; alpha: coverage.
  PageTexel base(const BakedSurfaces& surfaces, const Atlas& atlas, const TexelSites& sites,
                 size_t site) const;

 private:
  const Scene& scene_;
};

}  // namespace troffer
