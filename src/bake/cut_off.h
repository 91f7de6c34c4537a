// Finds dark places that a wall separates from lit places next to them.
//
// A floor often continues below walls and furniture and into the next room, and one texel may cover
// both sides. Nobody sees the floor inside a wall, but its darkness would show on the lit side: in
// the texel's mean, and by blending with the next texel. So dark places do not count if something
// stands between them and all lit places nearby.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/atlas.h"
#include "bake/site_light.h"

namespace troffer {

// A place on a surface and its light; the normal points to the lit side.
struct LitPlace {
  Vec3 position, normal;
  float light = 0;  // luminance
};

// Returns one flag per sample of a site: 1 if it is dark and cut off from the lit samples. offset:
// distance of ray origins from the surface. diagonal: of the scene's bounds.
std::vector<uint8_t> cut_off_samples(const PreparedScene& scene, std::span<const LitPlace> samples,
                                     float offset, float diagonal);

// Marks texels as unknown that are dark and cut off from lit neighbours, and the dark texels behind
// them. Page::fill() then takes their value from their neighbours.
void forget_cut_off_texels(const PreparedScene& scene, const TexelSites& sites, const Atlas& atlas,
                           std::vector<SiteLight>& light);

// True if at least half of the rays from a place hit something nearby, as inside walls and
// furniture. diagonal: of the scene's bounds.
bool is_enclosed(const PreparedScene& scene, const LitPlace& place, float offset, float diagonal);

}  // namespace troffer
