// Relays (scene/scene.h) from surfaces whose `mirror` has an alternate material. Used by
// RadianceSurfaces.
//
// References: [1] "The RADIANCE 5.1 Synthetic Imaging System", §2.1.2 (mirror).
#pragma once

#include <vector>

#include "import/recentre.h"
#include "scene/scene.h"

namespace troffer {

// Adds a flat polygon, with corners in the file's world, counterclockwise as seen from the
// mirroring side: one relay if it is convex, else one for each of its triangles.
void add_radiance_relays(const std::vector<Vec3d>& corners, const Rgb& reflectance, Scene& scene,
                         PlacedBounds& bounds);

}  // namespace troffer
