// What surfaces send of the light they get, as pictures without light of their own show it.
#pragma once

#include <vector>

#include "bake/atlas.h"
#include "bake/page.h"

namespace troffer {

// Colour by which a material scatters evenly, and how much of the surface is there, at texels: the
// mean over each. scene: the one that was lit, whose images have levels.
class SentLight {
 public:
  explicit SentLight(const Scene& scene) : scene_(scene) {}  // must outlive this

  // color: base colour; alpha: 1 where nothing cuts holes.
  PageTexel base(const BakedSurfaces& surfaces, const Atlas& atlas, const TexelSites& sites,
                 size_t site) const;

 private:
  const Scene& scene_;
};

}  // namespace troffer
