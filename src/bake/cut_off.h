// Dark places that a wall keeps apart from lit ones beside them.
//
// A floor often reaches below walls, furniture and into the next room, and a texel covers some of
// both. Nobody sees the floor inside a wall, but its darkness would show on the lit side: in the
// texel's mean, and in the next one, which is blended with it. So places without light do not count
// where something stands between them and all lit places near them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/atlas.h"
#include "bake/site_light.h"

namespace troffer {

// A place on a surface; the normal points to the lit side.
struct LitPlace {
  Vec3 position, normal;
  float light = 0;  // luminance
};

// Which of a site's samples are dark and cut off from its lit ones. offset: of rays (Ray offset).
std::vector<uint8_t> cut_off_samples(const PreparedScene& scene, std::span<const LitPlace> samples,
                                     float offset);

// Takes the light of texels that are dark and cut off from lit neighbours, and of those behind
// them, as not known: it is to come of the neighbours.
void forget_cut_off_texels(const PreparedScene& scene, const TexelSites& sites, const Atlas& atlas,
                           std::vector<SiteLight>& light);

// Whether looks from a place end close by, as they do within walls and furniture. diagonal: of the
// scene's bounds.
bool is_enclosed(const PreparedScene& scene, const LitPlace& place, float offset, float diagonal);

}  // namespace troffer
